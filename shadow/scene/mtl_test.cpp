// SPDX-License-Identifier: MIT
// What a material library says about coverage.
#include "shadow/scene/testing.h"

namespace gn {
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

TEST(Mtl, ALostMaskIsSaid) {
    const TempFolder folder;
    EXPECT_TRUE(has_note(with_material(folder, "map_d nowhere.png\n"), "'m' has lost its mask"));
}

}  // namespace
}  // namespace gn
