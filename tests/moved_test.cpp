// SPDX-License-Identifier: MIT
// A caster that moves takes its shadow along: in maps that are kept over frames, in volumes and in the truth alike.
#include "shadow/frame/history.h"
#include "shadow/scene/move.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gn {
namespace {

constexpr uint width = 96, height = 64;

Scene box_on_ground() {
    by_hand::SceneBuilder b;
    b.ground(8).box({-1, 0.5F, -1}, {1, 2.5F, 1}).light(by_hand::sun({0.3F, -1, 0.2F}));
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 9, 9), .forward_ws = glm::normalize(vec3(0, -1, -1))}};
    return scene;
}

FrameResult draw(SceneGpu& gpu, const Recipe& recipe, History* history) {
    return render_frame(test::device(), gpu, gpu.scene->cameras.front(), recipe,
                        {.width = width, .height = height, .picture = false, .history = history});
}

double error_against_truth(const Scene& scene, const FrameResult& frame) {
    const TruthResult truth =
        Truth(scene).trace(frame.samples.position_ws, frame.samples.normal_ws, scene.lights.front(), {.samples = 1});
    return visibility_errors(frame.visibility.front().values, truth.visibility, truth.counted, width, height)
        .rmse.value();
}

class Moved : public testing::TestWithParam<const char*> {};

TEST_P(Moved, CastersTakeTheirShadowAlong) {
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe(GetParam());
    Scene scene = box_on_ground();
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    const FrameResult still = draw(gpu, recipe, &history);
    EXPECT_EQ(draw(gpu, recipe, &history).visibility.front().values, still.visibility.front().values);

    // What was kept knows of the move: the frame is that of a scene that always stood so.
    move_object(scene, 1, glm::translate(mat4(1), vec3(2.5F, 0.25F, -1)));
    refresh_scene(test::device(), gpu);
    const FrameResult moved = draw(gpu, recipe, &history);
    SceneGpu anew = upload_scene(test::device(), scene);
    History empty(test::device());
    EXPECT_EQ(moved.visibility.front().values, draw(anew, recipe, &empty).visibility.front().values);
    EXPECT_EQ(moved.samples.position_ws, draw(anew, recipe, nullptr).samples.position_ws);

    // And the truth moved likewise: against it the old shadow would be far off.
    const double error = error_against_truth(scene, moved);
    FrameResult left_behind = moved;
    left_behind.visibility = still.visibility;
    EXPECT_LT(3 * error, error_against_truth(scene, left_behind)) << error;
}

INSTANTIATE_TEST_SUITE_P(Recipes, Moved,
                         testing::Values("hard,placement=cascades,cascades.scroll=1,resolution=512", "volumes",
                                         "silhouette,resolution=512"),
                         [](const auto& test) {
                             const std::string text = test.param;
                             return text.substr(0, text.find(','));
                         });

}  // namespace
}  // namespace gn
