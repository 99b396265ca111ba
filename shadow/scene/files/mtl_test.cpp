// SPDX-License-Identifier: MIT
// What a material library says about coverage.
#include "shadow/scene/testing.h"

namespace gn::mtl_test {
namespace {

using namespace testing_scene;

Scene with_material(const TempFolder& folder, std::string_view lines) {
    folder.write("a.mtl", fmt::format("newmtl m\n{}", lines));
    return load_scene(folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl m\nf 1 2 3\n"));
}

TEST(Mtl, DissolveWinsOverTransparencyInWhateverOrder) {
    const TempFolder folder;
    const auto alpha = [&](std::string_view lines) {
        return with_material(folder, lines).materials.at(0).base_color.a;
    };
    EXPECT_EQ(alpha("d 1\nTr 1\n"), 1.0F);
    EXPECT_EQ(alpha("Tr 1\nd 1\n"), 1.0F);
    EXPECT_EQ(alpha("d 0.25\nTr 0\n"), 0.25F);
    EXPECT_EQ(alpha("Tr 0.75\n"), 0.25F);
    EXPECT_EQ(alpha("d -halo 0.5\n"), 0.5F);
    EXPECT_EQ(alpha("d\n"), 1.0F);
    EXPECT_EQ(alpha("D 0.5\n"), 0.5F);
}

TEST(Mtl, WhollyTransparentMaterialsAreSaid) {
    const TempFolder folder;
    EXPECT_TRUE(has_note(with_material(folder, "d 0\n"), "'m' is wholly transparent"));
    EXPECT_TRUE(has_note(with_material(folder, "Tr 1\n"), "'m' is wholly transparent"));
    EXPECT_FALSE(has_note(with_material(folder, "d 1\nTr 1\n"), "transparent"));
    // Only where something wears it.
    folder.write("b.mtl", "newmtl m\nnewmtl unused\nd 0\n");
    const Scene scene =
        load_scene(folder.write("b.obj", "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl m\nf 1 2 3\n"));
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
}

// A picture of 4 x 1 texels with the given alphas.
std::string png(std::array<float, 4> alpha) {
    Image image(4, 1, 4, 1.0F);
    for (int x = 0; x < 4; ++x) {
        image.at(x, 0, 3) = alpha[static_cast<std::size_t>(x)];
    }
    const std::vector<std::byte> bytes = encode_png(image);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(Mtl, HolesInAColourMapAreAMaskAndSaid) {
    const TempFolder folder;
    folder.write("holes.png", png({1, 0, 1, 0}));
    folder.write("gloss.png", png({0.3F, 0.5F, 0.6F, 0.7F}));
    folder.write("none.png", png({0, 0, 0, 0}));
    const Scene holes = with_material(folder, "map_Kd holes.png\n");
    EXPECT_EQ(holes.materials.at(0).alpha_mode, AlphaMode::mask);
    EXPECT_TRUE(has_note(holes, "'m' has no map_d, and holes in the alpha of its map_Kd"));
    const Scene named = with_material(folder, "map_Kd holes.png\nmap_d holes.png\n");
    EXPECT_EQ(named.materials.at(0).alpha_mode, AlphaMode::mask);
    EXPECT_TRUE(named.notes.empty()) << named.notes[0];
    // What is neither there nor missing anywhere is something else: gloss, height. Nor is a picture of nothing but holes.
    for (const char* other : {"gloss.png", "none.png"}) {
        const Scene scene = with_material(folder, fmt::format("map_Kd {}\n", other));
        EXPECT_EQ(scene.materials.at(0).alpha_mode, AlphaMode::opaque) << other;
        EXPECT_TRUE(has_note(scene, "'m' has no map_d, and an alpha in its map_Kd that is no mask")) << other;
    }
}

TEST(Mtl, AMaskFinerThanItsColourKeepsItsHoles) {
    const TempFolder folder;
    const std::vector<std::byte> dot = encode_png(Image(1, 1, 3, 0.5F));
    folder.write("dot.png", {reinterpret_cast<const char*>(dot.data()), dot.size()});
    folder.write("holes.png", png({1, 0, 1, 0}));
    const Scene scene = with_material(folder, "map_Kd dot.png\nmap_d holes.png\n");
    const Image8& image = scene.textures.at(0).image;
    ASSERT_EQ(image.width, 4);
    EXPECT_EQ(image.rgba[3], 255);
    EXPECT_EQ(image.rgba[7], 0);
    EXPECT_EQ(image.rgba[4], image.rgba[0]);
}

TEST(Mtl, ScaleAndOffsetOfMapsMoveTheCoordinates) {
    const TempFolder folder;
    folder.write("holes.png", png({1, 0, 1, 0}));
    folder.write("a.mtl", "newmtl m\nmap_Kd -s 2 3 1 -o 0.5 0.25 holes.png\nmap_d -s 2 3 1 -o 0.5 0.25 holes.png\n");
    const Scene scene = load_scene(
        folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.5 0.5\nusemtl m\nf 1/1 2/1 3/1\n"));
    // u = 2 x 0.5 + 0.5; v = 3 x 0.5 + 0.25, counted from the picture's top.
    EXPECT_EQ(scene.uvs.at(scene.triangles.at(0).x), vec2(1.5F, 1.0F - 1.75F));
}

TEST(Mtl, StatementsThatWouldChangeWhatCastsAreSaid) {
    const TempFolder folder;
    const Scene scene = with_material(folder, "Tf 0 1 0\ndisp bumps.png\nmap_Tr holes.png\nKs 1 1 1\nillum 2\n");
    EXPECT_TRUE(has_note(scene, "'m': Tf, disp, map_Tr"));
    EXPECT_EQ(scene.notes.size(), 1U);
}

TEST(Mtl, ALostMaskIsSaid) {
    const TempFolder folder;
    EXPECT_TRUE(has_note(with_material(folder, "map_d nowhere.png\n"), "'m' has lost its mask"));
}

TEST(Mtl, CoverageThatIsNoNumberOrOutOfRangeIsSaid) {
    const TempFolder folder;
    for (const char* lines : {"d nan\n", "d half\n", "d 2\n", "Tr -1\n", "d -halo\n"}) {
        const Scene scene = with_material(folder, lines);
        EXPECT_EQ(scene.materials.at(0).base_color.a, 1.0F) << lines;
        EXPECT_TRUE(has_note(scene, "is no number from 0 to 1; its opacity counts as 1")) << lines;
    }
    EXPECT_TRUE(has_note(with_material(folder, "d -1\n"), "Material 'm': 'd -1' is no number"));
    EXPECT_TRUE(with_material(folder, "d 1\n").notes.empty());
}

TEST(Mtl, AMaterialThatIsDefinedAgainIsSaid) {
    const TempFolder folder;
    const Scene scene = with_material(folder, "Kd 1 0 0\nnewmtl m\nKd 0 1 0\n");
    EXPECT_EQ(vec3(scene.materials.at(0).base_color), vec3(1, 0, 0));
    EXPECT_TRUE(has_note(scene, "Material 'm' is defined again; the first definition counts"));
}

TEST(Mtl, WhollyTransparentIsSaidOnce) {
    const TempFolder folder;
    EXPECT_EQ(with_material(folder, "d 0\n").notes.size(), 1U);
}

}  // namespace
}  // namespace gn::mtl_test
