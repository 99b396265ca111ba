// SPDX-License-Identifier: MIT
// Models made by others, where they lie beside the source tree: open, thin, masked and of many parts. No sample away from an
// edge of the shadow differs from the traced hard shadow.
#include "base/paths.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/scene/move.h"
#include "tests/direct_scenes.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gn {
namespace parts {
const Part& direct_volumes();
}
namespace volumes_scenes_test {
namespace {

using namespace by_hand;

struct Model {
    const char* name;
    const char* file;
    bool slow = false;  ///< seconds a frame
};

class VolumesOfModels : public testing::TestWithParam<Model> {};

TEST_P(VolumesOfModels, have_no_mismatch) {
    const auto file = data_root() / "../shared/scenes" / GetParam().file;
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << "skipped: " << GetParam().file << " is not here";
    }
    if (GetParam().slow && !test::thorough()) {
        GTEST_SKIP() << "skipped: " << GetParam().file << " takes long";
    }
    Scene scene = load_scene(file.string());
    for (Light& light : scene.lights) {
        light.shape.radius = light.shape.angular_radius = 0.0F;
        light.shape.half_size = vec2(0);
    }
    std::size_t judged = 0;
    for (const Comparison& result : render_and_judge(scene, direct_recipe(parts::direct_volumes()), 160, 120)) {
        EXPECT_EQ(result.wrong, 0U) << result.judged << " judged, " << result.edge << " edges: " << result.first;
        judged += result.judged;
    }
    EXPECT_GT(judged, 200U);
}

const Model models[] = {{"courtyard_zdm2", "courtyard_zdm2/courtyard_zdm2.glb"},
                        {"kenney_city", "kenney_city/kenney_city.glb"},
                        {"monobloc_chair", "chairs_table/plastic_monobloc_chair.glb"},
                        {"oak_chair", "chairs_table/oakChair/oakChair.obj"},
                        {"fence", "thin_structures/fence/fence.obj"},
                        {"clothes_horse", "thin_structures/clothes-horse/clothes-horse.obj"},
                        {"iron_railing", "thin_structures/iron-railing-1/iron-railing-1.obj"},
                        {"teapot", "classic/teapot.obj"},
                        {"bush", "foliage_masked/bush.glb"},
                        {"christmas_tree", "foliage_masked/christmas_tree.glb"},
                        {"rooms_grid", "rooms_grid/rooms_grid.glb", true}};
INSTANTIATE_TEST_SUITE_P(Models, VolumesOfModels, testing::ValuesIn(models),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(VolumesOfBadMeshes, are_the_truth) {
    // Triangles without area, twice and turned over, apart from all else, of kilometres and of micrometres, in one mesh.
    SceneBuilder b;
    b.ground(10).box({-1, 0, -1}, {1, 1.5F, 1});
    b.mesh({{-2, 1, 0}, {-1, 1, 0.5F}, {-2, 2, 1}, {-1.5F, 1, 0.25F}},
           {{0, 1, 2}, {0, 1, 2}, {0, 2, 1}, {0, 0, 1}, {1, 1, 1}, {0, 3, 1}, {2, 1, 0}});
    b.mesh({{2, 1, 1}, {2, 1, 1.000001F}, {2.000001F, 1, 1}, {-4000, 2, -7000}, {4000, 2.2F, -7000}, {0, 900, -7100}},
           {{0, 1, 2}, {3, 4, 5}});
    b.camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0}).light(sun({-0.4F, -1, 0.33F})).light(point({2.3F, 3.1F, 0.7F}));
    const Scene scene = b.light(sun({0.1F, -0.2F, 1})).scene();
    for (const char* mode : {"auto", "z-fail", "zp+"}) {
        for (const char* extrude : {"silhouette", "brute-force"}) {
            const Recipe recipe = direct_recipe(parts::direct_volumes(), {{"mode", mode}, {"extrude", extrude}});
            for (const Comparison& result : render_and_judge(scene, recipe, 120, 90)) {
                EXPECT_EQ(result.wrong, 0U) << mode << ", " << extrude << ": " << result.first;
            }
        }
    }
}

TEST(VolumesOfGeometry, have_one_list_of_edges_for_all_lights_and_frames) {
    SceneBuilder b;
    b.ground(10).box({-1, 0, -1}, {1, 1.5F, 1}).camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
    Scene scene = b.light(sun({-0.4F, -1, 0.33F})).scene();
    SceneGpu uploaded = upload_scene(device(), scene);
    const auto draw = [&] {
        render_frame(device(), uploaded, scene.cameras.front(), direct_recipe(parts::direct_volumes()),
                     {.width = 64, .height = 48, .picture = false});
    };
    // What is asked for and not there is made here, and counted.
    int made = 0;
    const std::uint64_t key =
        casters_key(scene, std::vector<CasterKind>(scene.objects.size(), CasterKind::opaque)) * 2 + 1;
    const auto edges = [&] {
        return uploaded.derived->get(uploaded.version, "volume edges", key, [&] {
            ++made;
            return EdgeBuffers{};
        });
    };
    draw();
    const auto first = edges();
    const std::size_t kept = uploaded.derived->size();
    scene.lights.push_back(scene.lights[0]);
    scene.lights[1].shape = point({2.3F, 3.1F, 0.7F});
    scene.cameras[0].position_ws.x += 1;
    draw();
    EXPECT_EQ(edges(), first);
    EXPECT_EQ(uploaded.derived->size(), kept);
    // Only what moved makes them anew.
    move_object(scene, 1, glm::translate(mat4(1), vec3(0.5F, 0, 0)));
    refresh_scene(device(), uploaded);
    draw();
    EXPECT_NE(edges(), first);
    EXPECT_EQ(uploaded.derived->size(), kept);
    EXPECT_EQ(made, 0);
}

}  // namespace
}  // namespace volumes_scenes_test
}  // namespace gn
