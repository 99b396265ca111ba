// SPDX-License-Identifier: MIT
// Models made by others, good ones and bad ones, where they lie beside the source tree.
#include "base/paths.h"
#include "shadow/scene/rig.h"
#include "shadow/scene/testing.h"
#include "tests/thorough.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>

namespace gn::real_scenes_test {
namespace {

using namespace testing_scene;

std::filesystem::path scenes() {
    return data_root() / "../shared/scenes";
}

// Everything that later stages rely on.
void expect_sound(const Scene& scene) {
    ASSERT_FALSE(scene.materials.empty());
    ASSERT_FALSE(scene.lights.empty());
    ASSERT_FALSE(scene.cameras.empty());
    ASSERT_EQ(scene.normals_ws.size(), scene.positions_ws.size());
    ASSERT_EQ(scene.uvs.size(), scene.positions_ws.size());
    std::size_t unsound = 0;
    for (std::size_t v = 0; v < scene.positions_ws.size(); ++v) {
        const bool unit = std::abs(glm::length(scene.normals_ws[v]) - 1.0F) < 1e-4F;
        unsound += finite(scene.positions_ws[v]) && unit && finite(vec3(scene.uvs[v], 0.0F)) ? 0U : 1U;
    }
    EXPECT_EQ(unsound, 0U) << "vertices that are not finite or have no unit normal";
    std::size_t next = 0;
    for (const Object& object : scene.objects) {
        EXPECT_EQ(object.first_triangle, next);
        next += object.triangle_count;
        ASSERT_LT(static_cast<std::size_t>(object.material), scene.materials.size());
    }
    EXPECT_EQ(next, scene.triangles.size());
    for (const uvec3 t : scene.triangles) {
        ASSERT_LT(std::max({t.x, t.y, t.z}), scene.positions_ws.size());
    }
    for (const Camera& camera : scene.cameras) {
        EXPECT_TRUE(finite(camera.position_ws) && camera.near > 0.0F && camera.far > camera.near) << camera.name;
    }
    for (const Material& material : scene.materials) {
        EXPECT_LT(material.base_color_texture, static_cast<int>(scene.textures.size()));
    }
}

// Triangles that the file holds, those without area included.
std::size_t count_with_dropped(const Scene& scene) {
    std::size_t count = scene.triangles.size();
    for (const std::string& note : scene.notes) {
        unsigned long dropped = 0;
        if (std::sscanf(note.c_str(), "Dropped %lu triangle", &dropped) == 1) {
            count += dropped;
        }
    }
    return count;
}

struct Expected {
    const char* file;
    std::size_t triangles, lights, cameras;
};

class RealScene : public ::testing::TestWithParam<Expected> {};

TEST_P(RealScene, LoadsCompletely) {
    const std::filesystem::path file = scenes() / GetParam().file;
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << "skipped: " << GetParam().file << " is not here";
    }
    if (test::sanitized && GetParam().triangles > 1'000'000) {
        GTEST_SKIP() << "skipped: " << GetParam().file
                     << " takes a minute with sanitizers, which smaller files satisfy";
    }
    const Scene scene = load_scene(file.string());
    expect_sound(scene);
    EXPECT_EQ(count_with_dropped(scene), GetParam().triangles);
    EXPECT_EQ(scene.lights.size(), GetParam().lights);
    // Those of the file and `overview`, or one default.
    const std::size_t own = scene.cameras.size() - (scene.cameras.size() > 1 ? 1 : 0);
    EXPECT_EQ(own, GetParam().cameras);
}

// One light and one camera are also what a file without any gets.
INSTANTIATE_TEST_SUITE_P(
    All, RealScene,
    ::testing::Values(
        Expected{"apartment_interior/apartment.glb", 177'934, 1, 1},
        Expected{"hotel_room/hotel_room.glb", 99'029, 1, 1},
        Expected{"courtyard_zdm2/courtyard_zdm2.glb", 62'764, 4, 1},
        Expected{"living_room_lights/living_room.glb", 5'088, 3, 1},
        Expected{"light_testers/light_testers.glb", 83'750, 20, 1},
        Expected{"rooms_grid/rooms_grid.glb", 3'062'552, 2, 1}, Expected{"truck_town/truck_town.glb", 36'167, 11, 1},
        Expected{"kenney_city/kenney_city.glb", 21'808, 1, 1}, Expected{"dutch_ship/dutch_ship.glb", 69'162, 1, 1},
        Expected{"ingenuity/ingenuity.glb", 9'060, 1, 1}, Expected{"mars_crater/mars_crater.glb", 177'950, 1, 1},
        Expected{"characters/CesiumMan.glb", 4'672, 1, 1}, Expected{"foliage_masked/bush.glb", 40'292, 1, 1},
        Expected{"foliage_masked/christmas_tree.glb", 15'552, 1, 1},
        Expected{"chairs_table/plastic_monobloc_chair.glb", 3'356, 1, 1},
        Expected{"chairs_table/oakChair/oakChair.obj", 31'786, 1, 1},
        Expected{"chairs_table/oakTable/oakTable.obj", 5'160, 1, 1}, Expected{"classic/teapot.obj", 6'320, 1, 1},
        Expected{"classic/teapot_lowpoly.obj", 992, 1, 1}, Expected{"classic/spot.obj", 5'856, 1, 1},
        Expected{"classic/spot_quads.obj", 5'856, 1, 1}));

TEST(RealScenes, AWalkingManKeepsHisBones) {
    const std::filesystem::path file = scenes() / "characters/CesiumMan.glb";
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << "skipped: characters/CesiumMan.glb is not here";
    }
    AnimatedScene loaded = load_animated_scene(file.string());
    Scene& scene = loaded.scene;
    const Scene rest = scene;
    ASSERT_EQ(loaded.rig.animations.size(), 1U);
    for (const double share : {0.0, 0.3, 0.7, 1.0}) {
        EXPECT_TRUE(pose_scene(scene, loaded.rig, 0, share * loaded.rig.animations[0].seconds).empty());
        expect_sound(scene);
        // Bones are rigid, so that edges far from the joints keep their lengths: half of all within a hundredth.
        std::vector<double> changes;
        for (const uvec3 t : scene.triangles) {
            const double now = glm::distance(dvec3(scene.positions_ws[t.x]), dvec3(scene.positions_ws[t.y]));
            const double then = glm::distance(dvec3(rest.positions_ws[t.x]), dvec3(rest.positions_ws[t.y]));
            changes.push_back(std::abs(now / then - 1));
        }
        std::nth_element(changes.begin(), changes.begin() + changes.size() / 2, changes.end());
        EXPECT_LT(changes[changes.size() / 2], 0.01) << share;
        EXPECT_NE(scene.positions_ws, rest.positions_ws) << share;
    }
}

TEST(RealScenes, ThinStructuresLoad) {
    if (!std::filesystem::exists(scenes() / "thin_structures")) {
        GTEST_SKIP() << "skipped: thin_structures is not here";
    }
    for (const char* file :
         {"fence/fence.obj", "clothes-horse/clothes-horse.obj", "iron-railing-1/iron-railing-1.obj"}) {
        const Scene scene = load_scene((scenes() / "thin_structures" / file).string());
        expect_sound(scene);
        EXPECT_GT(scene.triangles.size(), 4'000U) << file;
    }
}

// Files that must end in a sentence; all others may load, but what loads is sound.
constexpr std::array<std::string_view, 14> refused{"dag_bomb_2e22.gltf",
                                                   "path_traversal.gltf",
                                                   "glb_minus_10.glb",
                                                   "RecursiveNodes.gltf",
                                                   "badArray.gltf",
                                                   "badUint.gltf",
                                                   "glb__empty_file.glb",
                                                   "root__invalid_array_elements.gltf",
                                                   "accessor__invalid_sparse_count_and_stride.gltf",
                                                   "buffer__not_found.gltf",
                                                   "node__node_loop.gltf",
                                                   "json_bad_utf8.gltf",
                                                   "box_textured_bitflips.glb",
                                                   ""};
const std::map<std::string_view, std::size_t> triangle_counts{{"mirrored_node.gltf", 1},
                                                              {"index_count_4.gltf", 1},
                                                              {"mode_1_lines.gltf", 0},
                                                              {"mode_6_fan.gltf", 2},
                                                              {"nan_positions.gltf", 0},
                                                              {"zero_vertices.gltf", 0},
                                                              {"accessor_no_bufferview.gltf", 0},
                                                              {"png_truncated.gltf", 1},
                                                              {"alpha_cutoff_5.gltf", 1},
                                                              {"index_huge.obj", 12},
                                                              {"face_before_vertices.obj", 1},
                                                              {"mtl_traversal.obj", 12},
                                                              {"nul_bytes.obj", 12},
                                                              {"line_continuation_crlf_tabs.obj", 13},
                                                              {"far_from_origin.obj", 12},
                                                              {"coplanar_duplicates.obj", 48},
                                                              {"AllIndicesOutOfRange.gltf", 0},
                                                              {"BoxBadNormals.glb", 12},
                                                              {"box_UTF16BE.obj", 12},
                                                              {"malformed2.obj", 10},
                                                              {"testmixed.obj", 12}};

TEST(BadFiles, EndInASentenceOrASoundScene) {
    if (!std::filesystem::exists(scenes() / "bad")) {
        GTEST_SKIP() << "skipped: the folder of bad models is not here";
    }
    std::size_t tried = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes() / "bad")) {
        const std::string name = entry.path().filename().string();
        const std::string type = entry.path().extension().string();
        if (type != ".gltf" && type != ".glb" && type != ".obj") {
            continue;
        }
        SCOPED_TRACE(name);
        ++tried;
        const auto start = std::chrono::steady_clock::now();
        bool loaded = false;
        try {
            const Scene scene = load_scene(entry.path().string());
            loaded = true;
            expect_sound(scene);
            const auto count = triangle_counts.find(name);
            if (count != triangle_counts.end()) {
                EXPECT_EQ(scene.triangles.size(), count->second);
            }
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
        const bool expected_refusal = std::find(refused.begin(), refused.end(), name) != refused.end();
        EXPECT_EQ(loaded, !expected_refusal);
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
    }
    EXPECT_GT(tried, 50U);
}

// Random damage to a real file: any outcome but a crash, a hang or an unsound scene.
TEST(BadFiles, RandomDamageNeverCrashes) {
    const TempFolder folder;
    for (const char* source :
         {"chairs_table/plastic_monobloc_chair.glb", "bad/assimp/BoxBadNormals.glb", "bad/made/alpha_cutoff_5.gltf",
          "bad/assimp/malformed2.obj", "kenney_city/kenney_city.glb"}) {
        if (!std::filesystem::exists(scenes() / source)) {
            GTEST_SKIP() << "skipped: " << source << " is not here";
        }
        std::ifstream in(scenes() / source, std::ios::binary);
        const std::string good{std::istreambuf_iterator<char>(in), {}};
        std::uint32_t state = 12345;
        const auto random = [&] { return state = state * 1664525U + 1013904223U, state >> 8U; };
        for (int round = 0; round < 40; ++round) {
            SCOPED_TRACE(fmt::format("{}, round {}", source, round));
            std::string bad = good;
            for (int flips = 0; flips < 10; ++flips) {
                // Half of the damage goes to the head, where the structure is.
                const std::size_t range = flips % 2 == 0 ? std::min<std::size_t>(bad.size(), 3000) : bad.size();
                bad[random() % range] ^= static_cast<char>(1U << (random() % 8U));
            }
            bad.resize(round % 8 == 7 ? random() % bad.size() : bad.size());
            const std::string file = folder.write("a" + std::filesystem::path(source).extension().string(), bad);
            try {
                expect_sound(load_scene(file));
            } catch (const Error&) {
            }
        }
    }
}

}  // namespace
}  // namespace gn::real_scenes_test
