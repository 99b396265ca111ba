// SPDX-License-Identifier: MIT
// A caster that moves takes its shadow along: in maps that are kept over frames, in volumes and in the truth alike.
#include "shadow/placement/place.h"
#include "shadow/scene/move.h"
#include "tests/direct_scenes.h"
#include "tests/moving.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cstring>

namespace gn::moved_test {
namespace {

class Moved : public testing::TestWithParam<const char*> {};

TEST_P(Moved, CastersTakeTheirShadowAlong) {
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe(GetParam());
    Scene scene = by_hand::box_on_ground();
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    const FrameResult still = test::draw_moving(gpu, recipe, &history);
    EXPECT_EQ(test::draw_moving(gpu, recipe, &history).visibility.front().values, still.visibility.front().values);

    // What was kept knows of the move: the frame is that of a scene that always stood so.
    const mat4 turn = glm::rotate(mat4(1), 0.3F, vec3(0, 1, 0));
    move_object(scene, 1, glm::translate(mat4(1), vec3(2.5F, 0.25F, -1)) * turn);
    refresh_scene(test::device(), gpu);
    const FrameResult moved = test::draw_moving(gpu, recipe, &history);
    SceneGpu anew = upload_scene(test::device(), scene);
    History empty(test::device());
    EXPECT_EQ(moved.visibility.front().values, test::draw_moving(anew, recipe, &empty).visibility.front().values);
    EXPECT_EQ(moved.samples.position_ws, test::draw_moving(anew, recipe, nullptr).samples.position_ws);

    // And the truth moved likewise: against it the old shadow would be far off.
    const double error = test::error_against_truth(scene, moved);
    FrameResult left_behind = moved;
    left_behind.visibility = still.visibility;
    EXPECT_LT(3 * error, test::error_against_truth(scene, left_behind)) << error;
}

/// A large ground, and on it two boxes of which one moves by `step`.
Scene two_boxes() {
    by_hand::SceneBuilder b;
    b.ground(8)
        .box({-1, 0.5F, -1}, {1, 2.5F, 1})
        .box({3, 0.5F, 2}, {3.5F, 1, 2.5F})
        .light(by_hand::sun({0.3F, -1, 0.2F}));
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 9, 9), .forward_ws = glm::normalize(vec3(0, -1, -1))}};
    return scene;
}

constexpr const char* scrolling = "hard,placement=cascades,cascades.scroll=1,resolution=512";

TEST(MovedMaps, AreDrawnAnewOnlyWhereSomethingMoved) {
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe(scrolling);
    Scene scene = two_boxes();
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    test::draw_moving(gpu, recipe, &history);
    move_object(scene, 2, glm::translate(mat4(1), vec3(0.5F, 0, -1)));
    refresh_scene(test::device(), gpu);

    // Where the box was and where it is are two small places of each map.
    FrameGraph graph(test::device());
    const SceneHandles handles = import_scene(graph, gpu);
    const ViewSamples samples =
        add_view_samples(graph, gpu, handles, scene.cameras.front(), test::moving_width, test::moving_height);
    const FrameInput input{test::device(), graph, scene, handles, samples, scene.lights.data(), 0, &history};
    const LightViews views = place_views(input, recipe);
    ASSERT_TRUE(views.kept.has_value());
    std::int64_t most = 0;
    for (const KeptLayer& layer : views.kept->layers) {
        std::int64_t texels = 0;
        for (const KeptDraw& piece : layer.revealed) {
            texels += std::int64_t{piece.rect.z} * piece.rect.w;
        }
        most = std::max(most, texels);
        EXPECT_LT(texels, 512 * 512 / 8);
    }
    EXPECT_GT(most, 2 * 10 * 10) << "half a metre is many texels";
}

TEST(MovedMaps, AreThoseOfASceneThatAlwaysStoodSo) {
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe(scrolling);
    Scene scene = two_boxes();
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    std::vector<float> before = test::draw_moving(gpu, recipe, &history).visibility.front().values;
    for (const vec3 step : {vec3(0.5F, 0, -1), vec3(-4, 0.3F, 0), vec3(0, -0.3F, 2)}) {
        // Twice before it is told: from where it was drawn last to where it ends.
        move_object(scene, 2, glm::translate(mat4(1), 2.0F * step));
        move_object(scene, 2, glm::translate(mat4(1), -step));
        refresh_scene(test::device(), gpu);
        const std::vector<float> moved = test::draw_moving(gpu, recipe, &history).visibility.front().values;
        SceneGpu anew = upload_scene(test::device(), scene);
        EXPECT_EQ(moved, test::draw_moving(anew, recipe, nullptr).visibility.front().values);
        EXPECT_NE(moved, before);
        before = moved;
    }
}

TEST(MovedScene, BringsOnlyWhatMoved) {
    Scene scene = two_boxes();
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::vector<vec3> uploaded = scene.positions_ws;
    const std::uint64_t version = gpu.version;
    refresh_scene(test::device(), gpu);
    EXPECT_EQ(gpu.version, version) << "nothing moved";
    move_object(scene, 2, glm::translate(mat4(1), vec3(1, 0, 0)));
    const std::vector<vec3> moved = scene.positions_ws;
    scene.positions_ws.front() = vec3(77);  // of the ground, whose version says that it is what it was
    refresh_scene(test::device(), gpu);
    EXPECT_NE(gpu.version, version);
    std::vector<vec3> held(moved.size());
    const std::vector<std::byte> bytes = download(test::device(), gpu.positions);
    std::memcpy(held.data(), bytes.data(), held.size() * sizeof(vec3));
    EXPECT_EQ(held, moved);
    EXPECT_NE(held, uploaded);

    // And tells where.
    const auto touched_ws = gpu.moves->since(version);
    ASSERT_TRUE(touched_ws.has_value());
    ASSERT_EQ(touched_ws->size(), 2U);
    EXPECT_EQ((*touched_ws)[1].min.x, (*touched_ws)[0].min.x + 1);
}

INSTANTIATE_TEST_SUITE_P(Recipes, Moved,
                         testing::Values("hard,placement=cascades,cascades.scroll=1,resolution=512", "volumes",
                                         "silhouette,resolution=512"),
                         [](const auto& test) {
                             const std::string text = test.param;
                             return text.substr(0, text.find(','));
                         });

}  // namespace
}  // namespace gn::moved_test
