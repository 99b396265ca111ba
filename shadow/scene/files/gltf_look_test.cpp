// SPDX-License-Identifier: MIT
// What a glTF file says about light, surface and view.
#include "shadow/scene/emission.h"
#include "shadow/scene/testing.h"

namespace gn::gltf_look_test {
namespace {

using namespace testing_scene;

Scene load(const GltfText& gltf) {
    const TempFolder folder;
    return load_scene(folder.write("a.gltf", gltf.text()));
}

GltfText with_light(const std::string& light, const std::string& node_extras = "") {
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.nodes = fmt::format(
        R"({{"mesh":0}},{{"name":"lamp","translation":[1,2,3],{}"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}})",
        node_extras);
    gltf.scene = R"("scenes":[{"nodes":[0,1]}],)";
    gltf.more = fmt::format(
        R"("extensionsUsed":["KHR_lights_punctual"],"extensions":{{"KHR_lights_punctual":{{"lights":[{}]}}}},)", light);
    return gltf;
}

TEST(GltfLight, PunctualLightsWithUnitsAndCones) {
    const Scene scene = load(with_light(
        R"({"type":"spot","color":[1,0.5,0.25],"intensity":40,"range":9,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.6}})"));
    ASSERT_EQ(scene.lights.size(), 1U);
    const GnLight& spot = scene.lights[0].shape;
    EXPECT_EQ(scene.lights[0].name, "lamp");
    EXPECT_EQ(spot.kind, static_cast<uint>(GN_LIGHT_SPOT));
    EXPECT_EQ(vec3(spot.position_ws), vec3(1, 2, 3));
    EXPECT_EQ(vec3(spot.direction_ws), vec3(0, 0, -1));
    EXPECT_EQ(vec3(spot.color), vec3(1, 0.5F, 0.25F));
    EXPECT_FLOAT_EQ(spot.intensity, 40.0F);
    EXPECT_FLOAT_EQ(spot.range, 9.0F);
    EXPECT_FLOAT_EQ(spot.cos_inner, std::cos(0.2F));
    EXPECT_FLOAT_EQ(spot.cos_outer, std::cos(0.6F));
}

TEST(GltfLight, SizesComeFromExtras) {
    const Scene bulb = load(with_light(R"({"type":"point","extras":{"gnomon":{"radius":0.05,"intensity":12}}})"));
    EXPECT_FLOAT_EQ(bulb.lights[0].shape.radius, 0.05F);
    EXPECT_FLOAT_EQ(bulb.lights[0].shape.intensity, 12.0F);
    const Scene sun = load(with_light(R"({"type":"directional","extras":{"gnomon":{"angular_diameter_deg":0.53}}})"));
    EXPECT_FLOAT_EQ(sun.lights[0].shape.angular_radius, 0.265F * pi / 180.0F);

    // The node overrides the light; a rectangle of 2 x 0.5 m with 10 cd has 10 cd/m^2.
    const Scene panel = load(with_light(R"({"type":"spot","intensity":10,"spot":{},"extras":{"gnomon":{"radius":1}}})",
                                        R"("extras":{"gnomon":{"rectangle":{"width":2,"height":0.5},"radius":0}},)"));
    const GnLight& rectangle = panel.lights[0].shape;
    EXPECT_EQ(rectangle.kind, static_cast<uint>(GN_LIGHT_RECTANGLE));
    EXPECT_EQ(rectangle.half_size, vec2(1.0F, 0.25F));
    EXPECT_FLOAT_EQ(rectangle.intensity, 10.0F);
    EXPECT_FLOAT_EQ(rectangle.radius, 0.0F);
    EXPECT_EQ(vec3(rectangle.right_ws), vec3(1, 0, 0));
    EXPECT_TRUE(has_note(load(with_light(R"({"type":"point","extras":{"gnomon":{"size":1}}})")), "no key 'size'"));
}

TEST(GltfLight, ImpossibleValuesAreRepairedWithNotes) {
    const Scene scene = load(with_light(
        R"({"type":"spot","intensity":-5,"range":-1,"color":[-1,1e30,1],"spot":{"innerConeAngle":0.3,"outerConeAngle":0}})"));
    const GnLight& spot = scene.lights[0].shape;
    EXPECT_EQ(spot.intensity, 0.0F);
    EXPECT_EQ(spot.range, 0.0F);
    EXPECT_EQ(spot.color.x, 0.0F);
    EXPECT_LE(spot.color.y, 1e4F);
    EXPECT_LT(spot.cos_outer, 1.0F);
    EXPECT_GT(spot.cos_inner, spot.cos_outer);
    EXPECT_TRUE(has_note(scene, "Light 'lamp' had an intensity -5"));
    const Scene missing = load(with_light(""));
    EXPECT_TRUE(has_note(missing, "names a light that is not there"));
    EXPECT_EQ(missing.lights[0].name, "sun");
}

TEST(GltfCamera, PerspectiveCamerasAndTheirRepair) {
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.nodes = R"({"mesh":0},{"name":"eye","camera":0,"translation":[0,1,4]},{"camera":1},{"camera":2})";
    gltf.scene = R"("scenes":[{"nodes":[0,1,2,3]}],)";
    gltf.more = R"("cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"zfar":50}},
        {"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0.1,"zfar":5}},
        {"type":"perspective","perspective":{"yfov":0,"znear":0,"zfar":-1}}],)";
    const Scene scene = load(gltf);
    ASSERT_EQ(scene.cameras.size(), 4U);  // and overview
    const Camera& eye = scene.camera("eye");
    EXPECT_EQ(eye.position_ws, vec3(0, 1, 4));
    EXPECT_EQ(eye.forward_ws, vec3(0, 0, -1));
    EXPECT_FLOAT_EQ(eye.yfov, 0.7F);
    EXPECT_FLOAT_EQ(eye.near, 0.1F);
    EXPECT_FLOAT_EQ(eye.far, 50.0F);
    EXPECT_EQ(scene.cameras[1].half_height, 1.0F);
    const Camera& broken = scene.cameras[2];
    EXPECT_GT(broken.yfov, 0.1F);
    EXPECT_GT(broken.near, 0.0F);
    EXPECT_GT(broken.far, broken.near);
    EXPECT_FALSE(has_note(scene, "was skipped"));
}

// A 2 x 1 PNG: a green texel with alpha 0, a red one with alpha 1.
const std::string two_texels =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAADUlEQVR4nGNg+M8ARgAL/Q"
    "L+hoPdtAAAAABJRU5ErkJggg==";

GltfText with_material(const std::string& material, const std::string& image_uri) {
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.add(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2", 5126, 3);
    gltf.primitives = R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0})";
    gltf.more = fmt::format(
        R"("materials":[{}],"textures":[{{"source":0,"sampler":0}}],"samplers":[{{"wrapS":33071}}],"images":[{{"uri":"{}"}}],)",
        material, image_uri);
    return gltf;
}

TEST(GltfMaterial, FactorsCoverageAndStrength) {
    const Scene scene = load(with_material(
        R"({"name":"leaf","alphaMode":"MASK","alphaCutoff":0.3,"doubleSided":true,"emissiveFactor":[1,0.5,0],
        "pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.25,"roughnessFactor":0.75},
        "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":8}}})",
        two_texels));
    const Material& leaf = scene.materials[static_cast<std::size_t>(scene.objects[0].material)];
    EXPECT_EQ(leaf.name, "leaf");
    EXPECT_EQ(leaf.base_color, vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_FLOAT_EQ(leaf.metallic, 0.25F);
    EXPECT_FLOAT_EQ(leaf.roughness, 0.75F);
    EXPECT_EQ(leaf.emissive, vec3(8, 4, 0));
    EXPECT_EQ(leaf.alpha_mode, AlphaMode::mask);
    EXPECT_FLOAT_EQ(leaf.alpha_cutoff, 0.3F);
    EXPECT_TRUE(leaf.double_sided);
    EXPECT_EQ(leaf.base_color_texture, -1);
    EXPECT_TRUE(scene.textures.empty());
}

TEST(GltfMaterial, TextureTransformIsAppliedToTheCoordinates) {
    const Scene scene = load(with_material(
        R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],
        "scale":[2,4]}}}}})",
        two_texels));
    ASSERT_EQ(scene.textures.size(), 1U) << (scene.notes.empty() ? "" : scene.notes[0]);
    EXPECT_FALSE(scene.textures[0].repeat_u);
    EXPECT_TRUE(scene.textures[0].repeat_v);
    EXPECT_EQ(scene.uvs[scene.triangles[0].x], vec2(0.5F, 0.25F));
    EXPECT_EQ(scene.uvs[scene.triangles[0].y], vec2(2.5F, 0.25F));
    EXPECT_EQ(scene.uvs[scene.triangles[0].z], vec2(0.5F, 4.25F));
}

TEST(GltfMaterial, ABrokenPictureCostsOnlyThePicture) {
    const std::string material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
    for (const std::string& uri :
         {two_texels.substr(0, two_texels.size() - 40), std::string("missing.png"), std::string("../../etc/passwd")}) {
        const Scene scene = load(with_material(material, uri));
        EXPECT_EQ(scene.triangles.size(), 1U) << uri;
        EXPECT_TRUE(scene.textures.empty()) << uri;
        EXPECT_TRUE(has_note(scene, "keeps its plain colour")) << uri;
    }
}

TEST(GltfMaterial, MirroredRepetitionTurnsEverySecondPicture) {
    GltfText gltf = with_material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})", two_texels);
    gltf.more.replace(gltf.more.find("33071"), 5, "33648");
    const Scene scene = load(gltf);
    ASSERT_EQ(scene.textures.size(), 1U);
    // A period is the picture and its image: texels a, b, b, a over two units of u, and as before along v.
    const Texture& texture = scene.textures[0];
    EXPECT_TRUE(texture.repeat_u);
    ASSERT_EQ(texture.image.width, 4);
    EXPECT_EQ(texture.image.height, 1);
    const auto alpha = [&](std::size_t x) { return texture.image.rgba[4 * x + 3]; };
    EXPECT_EQ((std::array{alpha(0), alpha(1), alpha(2), alpha(3)}), (std::array<std::uint8_t, 4>{0, 255, 255, 0}));
    EXPECT_EQ(scene.uvs[scene.triangles[0].y], vec2(0.5F, 0));
    EXPECT_EQ(scene.uvs[scene.triangles[0].z], vec2(0, 1));
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
}

/// One light, told once by a glTF file and once by a .toml scene: both show the same picture, the same way round.
TEST(GltfLight, ARectangleShowsATextureOfItsFile) {
    const std::string pictures = fmt::format(
        R"("textures":[{{"source":0}},{{"source":1,"sampler":0}}],"samplers":[{{"wrapS":33648}}],"images":[{{"uri":"no.png"}},{{"uri":"{}"}}],)",
        two_texels);
    const auto lit = [&](const std::string& light, const std::string& node = "") {
        GltfText gltf = with_light(light, node);
        gltf.more += pictures;
        return load(gltf);
    };
    const Scene scene =
        lit(R"({"type":"point","extras":{"gnomon":{"rectangle":{"width":2,"height":1},"intensity":5,"texture":0}}})",
            R"("extras":{"gnomon":{"texture":1}},)");
    const GnLight& shape = scene.lights[0].shape;
    const Image8* const picture = shown_picture(scene, shape);
    ASSERT_NE(picture, nullptr) << (scene.notes.empty() ? "" : scene.notes[0]);

    const TempFolder folder;
    Image panel(2, 1, 3, 0);
    panel.at(0, 0, 1) = 1;
    panel.at(1, 0, 0) = 1;
    write_png(folder.path() / "panel.png", panel);
    const Scene told = load_scene(folder.write("t.toml", R"(
[[light]]
kind = "rectangle"
position = [1, 2, 3]
direction = [0, 0, -1]
size = [2, 1]
intensity = 5
texture = "panel.png"
)"));
    const GnLight& other = told.lights[0].shape;
    ASSERT_NE(shown_picture(told, other), nullptr);
    EXPECT_EQ(picture->width, 2) << "a sampler that mirrors says nothing of a light";
    EXPECT_EQ(emission_at(*picture, vec2(0, 0.5F)), vec3(0, 1, 0));
    EXPECT_EQ(shape.half_size, other.half_size);
    for (const vec2 x : {vec2(-0.5F, 0.25F), vec2(0.5F, 0.75F)}) {
        EXPECT_EQ(gn_emission_place(shape, x), gn_emission_place(other, x));
        EXPECT_EQ(emission_at(*picture, gn_emission_place(shape, x)),
                  emission_at(*shown_picture(told, other), gn_emission_place(other, x)));
    }

    // What cannot be shown is said.
    EXPECT_TRUE(has_note(lit(R"({"type":"point","extras":{"gnomon":{"texture":1}}})"), "is of rectangles"));
    const auto of = [&](const char* texture) {
        return lit(fmt::format(
            R"({{"type":"point","extras":{{"gnomon":{{"rectangle":{{"width":2,"height":1}},"texture":{}}}}}}})",
            texture));
    };
    for (const char* texture : {"2", "-1", "\"panel\""}) {
        EXPECT_TRUE(has_note(of(texture), "one of the file's 2 textures")) << texture;
    }
    EXPECT_TRUE(has_note(of("0"), "the light keeps its plain colour"));
    EXPECT_EQ(shown_picture(of("0"), of("0").lights[0].shape), nullptr);
}

}  // namespace
}  // namespace gn::gltf_look_test
