// SPDX-License-Identifier: MIT
// Small inputs that once gave a wrong picture, where they lie beside the source tree: `scene` holds the same triangles as
// `expected`.
#include "base/paths.h"
#include "shadow/scene/casting.h"
#include "shadow/scene/testing.h"

#include <algorithm>

namespace gn::cases_test {
namespace {

using namespace testing_scene;

std::filesystem::path cases() {
    return data_root() / "../shared/cases";
}

// Corners of all triangles, sorted: neither the order of triangles nor that of vertices matters.
std::vector<std::array<float, 9>> sorted_triangles(const Scene& scene) {
    std::vector<std::array<float, 9>> all;
    for (const uvec3 t : scene.triangles) {
        std::array<std::array<float, 3>, 3> corners{};
        for (int i = 0; i < 3; ++i) {
            const vec3 p = scene.positions_ws[t[i]];
            corners[static_cast<std::size_t>(i)] = {p.x, p.y, p.z};
        }
        std::sort(corners.begin(), corners.end());
        std::array<float, 9> flat{};
        std::memcpy(flat.data(), corners.data(), sizeof(flat));
        all.push_back(flat);
    }
    std::sort(all.begin(), all.end());
    return all;
}

struct Pair {
    const char* scene;
    const char* expected;
};

class CasePair : public ::testing::TestWithParam<Pair> {};

TEST_P(CasePair, HoldsTheSameTriangles) {
    if (!std::filesystem::exists(cases())) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    const Scene scene = load_scene((cases() / GetParam().scene).string());
    const auto got = sorted_triangles(scene);
    const auto expected = sorted_triangles(load_scene((cases() / GetParam().expected).string()));
    ASSERT_EQ(got.size(), expected.size());
    float worst = 0.0F;
    for (std::size_t i = 0; i < got.size(); ++i) {
        for (std::size_t k = 0; k < 9; ++k) {
            worst = std::max(worst, std::abs(got[i][k] - expected[i][k]));
        }
    }
    // Coordinates are a few metres: four units in the last place of 4.
    EXPECT_LE(worst, 2e-6F);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
}

INSTANTIATE_TEST_SUITE_P(All, CasePair,
                         ::testing::Values(Pair{"eight_influences/scene.glb", "eight_influences/expected.glb"},
                                           Pair{"gpu_instancing/scene.glb", "gpu_instancing/expected.glb"},
                                           Pair{"gpu_instancing/scene_optional.glb", "gpu_instancing/expected.glb"},
                                           Pair{"morph_weights/mesh_weights.glb", "morph_weights/expected.glb"},
                                           Pair{"morph_weights/node_weights.glb", "morph_weights/expected.glb"},
                                           Pair{"node_visibility/scene.glb", "node_visibility/expected.glb"}));

const Material* material(const Scene& scene, std::string_view name) {
    for (const Material& m : scene.materials) {
        if (m.name == name) {
            return &m;
        }
    }
    return nullptr;
}

// A mask with holes: some texels are there and some are not.
bool has_mask(const Scene& scene, const Material* m) {
    if (m == nullptr || m->alpha_mode == AlphaMode::opaque || m->base_color_texture < 0) {
        return false;
    }
    const Image8& image = scene.textures[static_cast<std::size_t>(m->base_color_texture)].image;
    bool seen = false;
    bool hole = false;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        (image.rgba[i] >= 128 ? seen : hole) = true;
    }
    return seen && hole;
}

TEST(Cases, MasksAreRead) {
    if (!std::filesystem::exists(cases())) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    const Scene scene = load_scene((cases() / "specgloss_mask/scene.glb").string());
    EXPECT_TRUE(has_mask(scene, material(scene, "leaves")));
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
    // Pictures that cannot be read take the mask with them, and that is said: the WebP of these files has a header and no
    // picture behind it.
    for (const char* file : {"webp_mask/required.glb", "webp_mask/used_no_fallback.glb"}) {
        EXPECT_TRUE(has_note(load_scene((cases() / file).string()), "'leaves' has lost its mask")) << file;
    }
    const Scene fallback = load_scene((cases() / "webp_mask/fallback.glb").string());
    EXPECT_TRUE(has_mask(fallback, material(fallback, "leaves")));
}

// As the same file with the name as it stands on this disc.
TEST(Cases, NamesOfOtherSystems) {
    if (!std::filesystem::exists(cases())) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    const auto load = [](const char* file) {
        return load_scene((cases() / "mtl_windows_paths" / (std::string(file) + ".obj")).string());
    };
    const Scene good = load("good");
    EXPECT_TRUE(good.notes.empty()) << good.notes[0];
    ASSERT_TRUE(has_mask(good, material(good, "leaf")));
    for (const char* file : {"backslash", "dot", "case", "absolute", "kd_alpha"}) {
        const Scene scene = load(file);
        EXPECT_EQ(sorted_triangles(scene), sorted_triangles(good)) << file;
        ASSERT_TRUE(has_mask(scene, material(scene, "leaf"))) << file;
        EXPECT_EQ(material(scene, "leaf")->alpha_mode, material(good, "leaf")->alpha_mode) << file;
        EXPECT_EQ(scene.textures.at(0).image.rgba, good.textures.at(0).image.rgba) << file;
    }
    EXPECT_TRUE(has_note(load("case"), "'Textures/Leaf_Mask.png'"));
    EXPECT_TRUE(has_note(load("absolute"), "'Textures/Leaf_Mask.png'"));
    EXPECT_TRUE(has_note(load("kd_alpha"), "no map_d"));
}

TEST(Cases, AFolderAboveTheModelIsReadWhereItIsAllowed) {
    if (!std::filesystem::exists(cases())) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    const std::string file = (cases() / "parent_folder_texture/models/scene.gltf").string();
    const Scene refused = load_scene(file);
    EXPECT_TRUE(refused.textures.empty());
    EXPECT_TRUE(
        has_note(refused, "'../textures/leaf.png' lies outside the model's folder; allow it with --assets DIR"));
    for (const char* allowed : {"parent_folder_texture", "parent_folder_texture/textures"}) {
        const Scene scene = load_scene(file, {.assets = {cases() / allowed}});
        EXPECT_EQ(scene.textures.size(), 1U) << allowed;
        EXPECT_FALSE(has_note(scene, "leaf.png")) << allowed;
    }
}

TEST(Cases, LampsShineThroughTheirShades) {
    if (!std::filesystem::exists(cases())) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    const auto load = [](const char* file) {
        return load_scene((cases() / "glass_lampshade" / (std::string(file) + ".glb")).string());
    };
    // Without the shade everything casts.
    const Scene none = load("none");
    EXPECT_EQ(casters(none, none.lights.at(0)).size(), none.objects.size());
    EXPECT_TRUE(none.notes.empty()) << none.notes[0];
    for (const char* file : {"blend_60", "transmission", "emissive_bulb"}) {
        const Scene scene = load(file);
        EXPECT_EQ(scene.objects.size() - casters(scene, scene.lights.at(0)).size(), 1U) << file;
        EXPECT_FALSE(scene.notes.empty()) << file;
    }
}

TEST(Cases, OneSideIsKeptApart) {
    if (!std::filesystem::exists(cases())) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    for (const char* file : {"away", "card_back", "card_front", "room_inward", "towards"}) {
        const Scene scene = load_scene((cases() / "single_sided" / (std::string(file) + ".glb")).string());
        const auto single = std::count_if(scene.objects.begin(), scene.objects.end(),
                                          [&](const Object& object) { return is_single_sided(scene, object); });
        EXPECT_GT(single, 0) << file;
        EXPECT_TRUE(scene.notes.empty()) << file << ": " << scene.notes[0];
    }
}

TEST(Cases, SheetsBackToBackKeepBothFaces) {
    if (!std::filesystem::exists(cases())) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    const Scene scene = load_scene((cases() / "coplanar_double_faces/sheets.obj").string());
    const auto faces = sorted_triangles(scene);
    EXPECT_NE(std::adjacent_find(faces.begin(), faces.end()), faces.end()) << "no face lies on another";
    EXPECT_NE(material(scene, "upper"), nullptr);
    EXPECT_NE(material(scene, "under"), nullptr);
}

TEST(Cases, TransparencyOfMaterialLibraries) {
    if (!std::filesystem::exists(cases())) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    const auto alpha = [](const char* file, bool said) {
        const Scene scene = load_scene((cases() / "mtl_transparency" / (std::string(file) + ".obj")).string());
        EXPECT_EQ(has_note(scene, "wholly transparent"), said) << file;
        return material(scene, "body")->base_color.a;
    };
    EXPECT_EQ(alpha("d1_tr0", false), 1.0F);
    EXPECT_EQ(alpha("d1_tr1", false), 1.0F);
    EXPECT_EQ(alpha("tr1_d1", false), 1.0F);
    EXPECT_EQ(alpha("d_halo", false), 1.0F);
    EXPECT_EQ(alpha("tr0_d0", true), 0.0F);
    EXPECT_EQ(alpha("d0_illum", true), 0.0F);
    EXPECT_EQ(alpha("tr1_only", true), 0.0F);
}

}  // namespace
}  // namespace gn::cases_test
