// SPDX-License-Identifier: MIT
#include "shadow/scene/files/polygon.h"
#include "shadow/scene/testing.h"

namespace gn::obj_test {
namespace {

using namespace testing_scene;
using namespace std::string_view_literals;

Scene load(std::string_view text) {
    const TempFolder folder;
    return load_scene(folder.write("a.obj", text));
}

constexpr std::string_view corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, QuadsNegativeIndicesAndFacesBeforeTheirVertices) {
    EXPECT_EQ(load(std::string(corners) + "f 1 2 3 4\n").triangles.size(), 2U);
    const Scene negative = load(std::string(corners) + "f -4 -3 -2\n");
    ASSERT_EQ(negative.triangles.size(), 1U);
    EXPECT_GT(winding(negative, 0).z, 0.0F);
    EXPECT_EQ(load("f 1 2 3\n" + std::string(corners)).triangles.size(), 1U);
}

TEST(Obj, ImpossibleFacesAreDroppedWithANote) {
    const Scene scene = load(std::string(corners) +
                             "f 1 2 3\nf 1 2 99999999999999999999\nf 0 1 2\nf -9 1 2\nf\nf 1 2\nf 1 2 5\nf a b c\n");
    EXPECT_EQ(scene.triangles.size(), 1U);
    EXPECT_TRUE(has_note(scene, "Dropped 7 faces"));
}

TEST(Obj, WhatIsNotReadIsCounted) {
    const Scene scene = load(std::string(corners) +
                             "vt 0 0\nf 1/1/1 2/7/-3 3/1\nl 1 2\np 1\np 2\nvp 0 1\ncstype bezier\ndeg 3\n"
                             "curv 0 1 1 2 3 4\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nend\nbzp 1 2 3 4\ncall more.obj\n"
                             "s 1\nusemap x\nfoo 1\nbar 2\n");
    EXPECT_EQ(scene.triangles.size(), 1U);
    EXPECT_TRUE(has_note(scene, "Skipped 3 lines and points"));
    EXPECT_TRUE(has_note(scene, "Skipped 3 free-form curves and surfaces"));
    EXPECT_TRUE(has_note(scene, "1 texture coordinate that is not there"));
    EXPECT_TRUE(has_note(scene, "2 normals that are not there"));
    EXPECT_TRUE(has_note(scene, "1 other file that it calls"));
    EXPECT_TRUE(has_note(scene, "Did not understand 2 lines, the first of them 'foo'"));
    const Scene colored = load("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n");
    EXPECT_TRUE(has_note(colored, "3 vertices have colours"));
    EXPECT_TRUE(load("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1.0\nvt 0 0 0\nf 1 2 3\n").notes.empty());
}

TEST(Obj, AnyLineEndingSpacingEncodingAndNumber) {
    EXPECT_EQ(load("v 0 0 0\r\nv\t+1 0. 0e0\r\nv 0 1E0 0\r\nf 1 \\\r\n 2 3").triangles.size(), 1U);
    EXPECT_EQ(load("v\0 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"sv).triangles.size(), 1U);
    std::string wide("\xFF\xFE", 2);
    for (const char c : std::string(corners) + "f 1 2 3\n") {
        wide += c;
        wide += '\0';
    }
    EXPECT_EQ(load(wide).triangles.size(), 1U);
    EXPECT_TRUE(has_note(load(std::string(corners) + "v x y z\nf 1 2 3"), "no numbers"));
}

TEST(Obj, NormalsTextureCoordinatesAndGroups) {
    const Scene scene =
        load(std::string(corners) + "vt 0.25 0.75\nvn 0 0 2\no left\nf 1/1/1 2/1/1 3/1/1\no right\nf 1//1 3//1 4//1\n");
    ASSERT_EQ(scene.objects.size(), 2U);
    EXPECT_EQ(scene.objects[0].name, "left");
    EXPECT_EQ(scene.uvs[scene.triangles[0].x], vec2(0.25F, 0.25F));
    EXPECT_EQ(scene.normals_ws[scene.triangles[0].x], vec3(0, 0, 1));
}

TEST(Obj, MaterialsFromTheLibraryBesideIt) {
    const TempFolder folder;
    folder.write("my stuff.mtl", "newmtl red\nKd 1 0 0\nd 0.25\nPr 0.4\nPm 1\nnewmtl glow\nKe 3 2 1\n");
    const Scene scene =
        load_scene(folder.write("a.obj", "mtllib my stuff.mtl\n" + std::string(corners) +
                                             "usemtl red\nf 1 2 3\nusemtl glow\nf 1 3 4\nusemtl no\nf 1 2 4\n"));
    ASSERT_EQ(scene.objects.size(), 3U);
    const Material& red = scene.materials[static_cast<std::size_t>(scene.objects[0].material)];
    EXPECT_EQ(red.base_color, vec4(1, 0, 0, 0.25F));
    EXPECT_EQ(red.alpha_mode, AlphaMode::blend);
    EXPECT_FLOAT_EQ(red.roughness, 0.4F);
    EXPECT_FLOAT_EQ(red.metallic, 1.0F);
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.objects[1].material)].emissive, vec3(3, 2, 1));
    EXPECT_TRUE(has_note(scene, "Material 'no' is not defined"));
}

// A 2 x 1 PNG in grey, white beside black, without an alpha channel.
constexpr std::array<unsigned char, 68> grey_png{
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44, 0x52, 0x00,
    0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0xD1, 0x49, 0x20, 0x56, 0x00,
    0x00, 0x00, 0x0B, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9C, 0x63, 0xF8, 0xCF, 0x00, 0x00, 0x02, 0x01, 0x01,
    0x00, 0x32, 0xBA, 0x2B, 0x92, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

TEST(Obj, ACoverageMapWithoutAlphaBecomesTheAlpha) {
    const TempFolder folder;
    folder.write("mask.png", {reinterpret_cast<const char*>(grey_png.data()), grey_png.size()});
    folder.write("leaf.mtl", "newmtl leaf\nKd 0 1 0\nmap_d -clamp on mask.png\n");
    const Scene scene =
        load_scene(folder.write("a.obj", "mtllib leaf.mtl\n" + std::string(corners) + "usemtl leaf\nf 1 2 3\n"));
    const Material& leaf = scene.materials[static_cast<std::size_t>(scene.objects[0].material)];
    EXPECT_EQ(leaf.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(vec3(leaf.base_color), vec3(0, 1, 0));
    ASSERT_EQ(scene.textures.size(), 1U) << (scene.notes.empty() ? "" : scene.notes[0]);
    EXPECT_FALSE(scene.textures[0].repeat_u);
    EXPECT_EQ(scene.textures[0].image.rgba, (std::vector<std::uint8_t>{255, 255, 255, 255, 255, 255, 255, 0}));
}

TEST(Obj, LibrariesOutsideTheFolderAreIgnoredWithANote) {
    const TempFolder folder;
    folder.write("secret.mtl", "newmtl red\nKd 1 0 0\n");
    for (const char* name : {"../secret.mtl", "/etc/passwd", "..\\secret.mtl", "c:\\secret.mtl"}) {
        const Scene scene =
            load_scene(folder.write("model/a.obj", fmt::format("mtllib {}\n{}usemtl red\nf 1 2 3\n", name, corners)));
        EXPECT_TRUE(has_note(scene, "Material library ignored")) << name;
        EXPECT_NE(vec3(scene.materials[0].base_color), vec3(1, 0, 0)) << name;
    }
}

TEST(Obj, FarFromZeroKeepsFullPrecision) {
    const Scene scene = load("v 10000000.25 0 3\nv 10000001.5 0 3\nv 10000000.25 1 3\nf 1 2 3\n");
    const uvec3 t = scene.triangles.at(0);
    EXPECT_EQ(scene.positions_ws[t.y] - scene.positions_ws[t.x], vec3(1.25F, 0, 0));
    EXPECT_EQ(scene.origin + dvec3(scene.positions_ws[t.x]), dvec3(10000000.25, 0, 3));
    EXPECT_LT(glm::length(scene.bounds_ws.centre()), 4.0F);
}

TEST(Polygon, ConcaveOnesAreCutWithoutOverlap) {
    // An arrow head whose fan from the first corner would leave the polygon.
    const std::vector<dvec3> arrow{{2, 0, 0}, {0, 2, 0}, {-2, 0, 0}, {0, 0.5, 0}};
    double area = 0.0;
    for (const uvec3 t : triangulate(arrow)) {
        const double signed_area = 0.5 * glm::cross(arrow[t.y] - arrow[t.x], arrow[t.z] - arrow[t.x]).z;
        EXPECT_GT(signed_area, 0.0);
        area += signed_area;
    }
    EXPECT_DOUBLE_EQ(area, 3.0);
    EXPECT_TRUE(triangulate(std::vector<dvec3>{{0, 0, 0}, {1, 0, 0}}).empty());
}

}  // namespace
}  // namespace gn::obj_test
