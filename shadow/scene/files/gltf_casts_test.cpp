// SPDX-License-Identifier: MIT
// What of a glTF file decides where triangles stand and whether they are there at all.
#include "shadow/scene/testing.h"

namespace gn::gltf_casts_test {
namespace {

using namespace testing_scene;

Scene load(const GltfText& gltf) {
    const TempFolder folder;
    return load_scene(folder.write("a.gltf", gltf.text()));
}

GltfText one_triangle() {
    GltfText gltf;
    gltf.add_points(triangle);
    return gltf;
}

vec3 corner(const Scene& scene, std::size_t index, int slot) {
    return scene.positions_ws.at(scene.triangles.at(index)[slot]);
}

// Accessor 1 lifts the third corner by 2 in z; accessor 2 turns every normal towards x.
GltfText morphing(const char* targets) {
    GltfText gltf = one_triangle();
    gltf.add_points({0, 0, 0, 0, 0, 0, 0, 0, 2});
    gltf.add_points({1, 0, -1, 1, 0, -1, 1, 0, -1});
    gltf.add_points({0, 0, 1, 0, 0, 1, 0, 0, 1});
    gltf.primitives = fmt::format(R"({{"attributes":{{"POSITION":0,"NORMAL":3}},"targets":[{}]}})", targets);
    return gltf;
}

TEST(GltfMorph, WeightsOfTheMeshMoveItsVertices) {
    GltfText gltf = morphing(R"({"POSITION":1,"NORMAL":2})");
    gltf.primitives += R"(],"weights":[0.5)";
    const Scene scene = load(gltf);
    ASSERT_EQ(scene.triangles.size(), 1U);
    EXPECT_EQ(corner(scene, 0, 2), vec3(0, 1, 1));
    EXPECT_EQ(corner(scene, 0, 1), vec3(1, 0, 0));
    // Half way from +z to +x.
    EXPECT_NEAR(scene.normals_ws[scene.triangles[0].x].x, std::sqrt(0.5F), 1e-6F);
}

TEST(GltfMorph, WeightsOfTheNodeGoBeforeThoseOfTheMesh) {
    GltfText gltf = morphing(R"({"POSITION":1})");
    gltf.primitives += R"(],"weights":[0.5)";
    gltf.nodes = R"({"mesh":0},{"mesh":0,"weights":[-1]})";
    gltf.scene = R"("scenes":[{"nodes":[0,1]}],)";
    const Scene scene = load(gltf);
    ASSERT_EQ(scene.triangles.size(), 2U);
    EXPECT_EQ(corner(scene, 0, 2), vec3(0, 1, 1));
    EXPECT_EQ(corner(scene, 1, 2), vec3(0, 1, -2));
}

TEST(GltfMorph, SeveralTargetsAddUpAndOnlyWeightedOnesAreRead) {
    GltfText gltf = morphing(R"({"POSITION":1},{"POSITION":1},{"POSITION":99})");
    gltf.nodes = R"({"mesh":0,"weights":[1,0.5,0]})";
    EXPECT_EQ(corner(load(gltf), 0, 2), vec3(0, 1, 3));
}

TEST(GltfMorph, ATargetOfAnotherLengthIsSaid) {
    GltfText gltf = one_triangle();
    gltf.add_points({0, 0, 5, 0, 0, 5});
    gltf.primitives = R"({"attributes":{"POSITION":0},"targets":[{"POSITION":1}]})";
    gltf.nodes = R"({"mesh":0,"weights":[1]})";
    const Scene scene = load(gltf);
    EXPECT_EQ(corner(scene, 0, 1), vec3(1, 0, 5));
    EXPECT_EQ(corner(scene, 0, 2), vec3(0, 1, 0));
    EXPECT_TRUE(has_note(scene, "morph target"));
}

TEST(GltfVisibility, HiddenNodesHideTheirChildrenAndTheirLights) {
    GltfText gltf = one_triangle();
    gltf.nodes = R"({"mesh":0},
        {"mesh":0,"children":[2],"extensions":{"KHR_node_visibility":{"visible":false}}},
        {"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}},
        {"mesh":0,"extensions":{"KHR_node_visibility":{"visible":true}}})";
    gltf.scene = R"("scenes":[{"nodes":[0,1,3]}],)";
    gltf.more = R"("extensionsUsed":["KHR_node_visibility","KHR_lights_punctual"],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","name":"lamp"}]}},)";
    const Scene scene = load(gltf);
    EXPECT_EQ(scene.triangles.size(), 2U);
    for (const Light& light : scene.lights) {
        EXPECT_EQ(light.shape.kind, static_cast<std::uint32_t>(GN_LIGHT_DIRECTIONAL)) << light.name;
    }
}

// Four joints stand still with a tenth each; a fifth, in the second set, is raised by 5 with six tenths.
TEST(GltfSkin, EverySetOfInfluencesCounts) {
    GltfText gltf = one_triangle();
    gltf.add(std::vector<std::uint8_t>{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}, "VEC4", 5121, 3);
    gltf.add(std::vector<float>(12, 0.1F), "VEC4", 5126, 3);
    gltf.add(std::vector<std::uint8_t>{4, 0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0}, "VEC4", 5121, 3);
    gltf.add(std::vector<float>{0.6F, 0, 0, 0, 0.6F, 0, 0, 0, 0.6F, 0, 0, 0}, "VEC4", 5126, 3);
    gltf.primitives = R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2,"JOINTS_1":3,"WEIGHTS_1":4}})";
    gltf.nodes = R"({"mesh":0,"skin":0},{},{},{},{},{"translation":[0,5,0]})";
    gltf.scene = R"("scenes":[{"nodes":[0,1,2,3,4,5]}],)";
    gltf.more = R"("skins":[{"joints":[1,2,3,4,5]}],)";
    EXPECT_NEAR(corner(load(gltf), 0, 0).y, 3.0F, 1e-5F);
}

GltfText instanced(const char* attributes) {
    GltfText gltf = one_triangle();
    gltf.nodes = fmt::format(
        R"({{"mesh":0,"translation":[10,0,0],"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{{}}}}}}}}})",
        attributes);
    gltf.more = R"("extensionsUsed":["EXT_mesh_gpu_instancing"],)";
    return gltf;
}

TEST(GltfInstancing, EachInstanceIsMovedTurnedAndScaledBelowItsNode) {
    GltfText gltf = instanced(R"("TRANSLATION":1,"ROTATION":2,"SCALE":3)");
    gltf.add_points({0, 1, 0, 0, 2, 0});
    // A half turn about y as normalized shorts, and none.
    gltf.add(std::vector<std::int16_t>{0, 32767, 0, 0, 0, 0, 0, 32767}, "VEC4", 5122, 2, R"(,"normalized":true)");
    gltf.add_points({3, 1, 1, 1, 1, 1});
    const Scene scene = load(gltf);
    ASSERT_EQ(scene.triangles.size(), 2U);
    EXPECT_LT(glm::distance(corner(scene, 0, 1), vec3(10 - 3, 1, 0)), 1e-5F);
    EXPECT_LT(glm::distance(corner(scene, 1, 1), vec3(11, 2, 0)), 1e-5F);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
}

TEST(GltfInstancing, ListsOfDifferentLengthsAreSaidAndBadOnesRefused) {
    GltfText gltf = instanced(R"("TRANSLATION":1,"SCALE":2)");
    gltf.add_points({0, 1, 0, 0, 2, 0});
    gltf.add_points({1, 1, 1});
    const Scene scene = load(gltf);
    EXPECT_EQ(scene.triangles.size(), 1U);
    EXPECT_TRUE(has_note(scene, "EXT_mesh_gpu_instancing"));

    const TempFolder folder;
    EXPECT_NE(error_of(folder.write("a.gltf", instanced(R"("TRANSLATION":77)").text())), "");
    GltfText many = instanced(R"("TRANSLATION":1)");
    many.add_points({0, 0, 0});
    many.accessors += R"(,{"componentType":5126,"type":"VEC3","count":2147483648})";
    many.nodes = R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":2}}}})";
    EXPECT_NE(error_of(folder.write("b.gltf", many.text())), "");
}

TEST(GltfSpecularGlossiness, DiffuseIsTheColourAndTheMask) {
    GltfText gltf = one_triangle();
    gltf.primitives = R"({"attributes":{"POSITION":0},"material":0})";
    gltf.more = R"("extensionsUsed":["KHR_materials_pbrSpecularGlossiness"],
        "materials":[{"alphaMode":"MASK","extensions":{"KHR_materials_pbrSpecularGlossiness":{
            "diffuseFactor":[0.5,0.25,0.125,0.75],"glossinessFactor":0.25}}}],)";
    const Scene scene = load(gltf);
    EXPECT_EQ(scene.materials[0].base_color, vec4(0.5F, 0.25F, 0.125F, 0.75F));
    EXPECT_FLOAT_EQ(scene.materials[0].roughness, 0.75F);
    EXPECT_FLOAT_EQ(scene.materials[0].metallic, 0.0F);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
}

// A strip of right triangles with sides of a hundredth, from x on.
GltfText strip(float x) {
    GltfText gltf;
    std::vector<float> xyz;
    for (int i = 0; i < 64; ++i) {
        for (const vec2 corner : {vec2(0, 0), vec2(0.01F, 0), vec2(0, 0.01F)}) {
            xyz.insert(xyz.end(), {x + 0.02F * static_cast<float>(i) + corner.x, corner.y, 0});
        }
    }
    gltf.add_points(xyz);
    return gltf;
}

TEST(GltfPositions, FeaturesFinerThanTheFilesFloatsAreSaid) {
    // At 5e5 floats stand 1/32 apart: a centimetre is not there. A node that moves a mesh by as much does no harm.
    const Scene coarse = load(strip(5e5F));
    EXPECT_TRUE(has_note(coarse, "steps of 0.0312"));
    GltfText moved = strip(0);
    moved.nodes = R"({"mesh":0,"translation":[500000,0,0]})";
    EXPECT_FALSE(has_note(load(moved), "steps of"));
    EXPECT_FALSE(has_note(load(strip(500)), "steps of"));
}

TEST(GltfExtensions, WhatIsNotUnderstoodIsSaidByName) {
    GltfText gltf = one_triangle();
    gltf.more = R"("extensionsUsed":["KHR_materials_ior","KHR_xmp_json_ld","ACME_holes","KHR_texture_basisu"],)";
    const Scene scene = load(gltf);
    EXPECT_TRUE(has_note(scene, "KHR_materials_ior"));
    EXPECT_TRUE(has_note(scene, "ACME_holes"));
    EXPECT_TRUE(has_note(scene, "KHR_texture_basisu"));
    EXPECT_FALSE(has_note(scene, "KHR_xmp_json_ld"));
    gltf.more = R"("extensionsUsed":["KHR_lights_punctual","KHR_mesh_quantization","KHR_texture_transform"],)";
    EXPECT_TRUE(load(gltf).notes.empty());
}

TEST(GltfExtensions, ALostMaskIsSaid) {
    GltfText gltf = one_triangle();
    gltf.primitives = R"({"attributes":{"POSITION":0},"material":0})";
    const char* material =
        R"("materials":[{"name":"leaves","alphaMode":"MASK","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)";
    for (const char* textures :
         {R"("textures":[{"extensions":{"KHR_texture_basisu":{"source":0}}}],"images":[{"uri":"a.ktx2"}],)",
          R"("textures":[],)", R"("textures":[{"source":7}],)",
          R"("textures":[{"source":0}],"images":[{"uri":"a.png"}],)"}) {
        gltf.more = std::string(material) + textures;
        EXPECT_TRUE(has_note(load(gltf), "'leaves' has lost its mask")) << textures;
    }
}

TEST(GltfExtensions, SeveralScenesAndAnimationsAreSaid) {
    GltfText gltf = one_triangle();
    gltf.scene = R"("scene":0,"scenes":[{"nodes":[0]},{"nodes":[]}],)";
    EXPECT_TRUE(has_note(load(gltf), "2 scenes"));
    gltf = one_triangle();
    gltf.add(std::vector<float>{0}, "SCALAR", 5126, 1);
    gltf.more = R"("animations":[{"samplers":[{"input":1,"output":0}],
        "channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}],)";
    EXPECT_TRUE(has_note(load(gltf), "animation"));
}

TEST(GltfSkin, VerticesThatNoJointHoldsAreSaid) {
    const auto skinned = [](std::uint8_t joint, float weight) {
        GltfText gltf = one_triangle();
        gltf.add(std::vector<std::uint8_t>{joint, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 5121, 3);
        gltf.add(std::vector<float>{weight, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 5126, 3);
        gltf.primitives = R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}})";
        gltf.nodes = R"({"mesh":0,"skin":0},{"translation":[0,5,0]})";
        gltf.scene = R"("scenes":[{"nodes":[0,1]}],)";
        gltf.more = R"("skins":[{"joints":[1]}],)";
        return load(gltf);
    };
    EXPECT_TRUE(skinned(0, 0.25F).notes.empty()) << "weights need not sum to one";
    for (const Scene& scene : {skinned(7, 1), skinned(0, 0), skinned(0, std::nanf(""))}) {
        EXPECT_TRUE(has_note(scene, "1 vertex of a skinned mesh hangs on no joint"));
        EXPECT_EQ(corner(scene, 0, 0), vec3(0));
        EXPECT_EQ(corner(scene, 0, 1), vec3(1, 5, 0));
    }
}

TEST(GltfExtensions, WhatLetsLightThroughAndIsNotReadIsSaidToCast) {
    GltfText gltf = one_triangle();
    for (const char* name : {"KHR_materials_diffuse_transmission", "ADOBE_materials_thin_transparency"}) {
        gltf.more = fmt::format(R"("extensionsUsed":["{}"],)", name);
        const Scene scene = load(gltf);
        EXPECT_TRUE(has_note(scene, "casts as if it were solid")) << name;
        EXPECT_FALSE(has_note(scene, "only changes how surfaces look")) << name;
    }
}

}  // namespace
}  // namespace gn::gltf_casts_test
