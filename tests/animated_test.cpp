// SPDX-License-Identifier: MIT
// What an animation bends takes its shadow along: in maps that are kept, in volumes and edges, and in the truth alike.
#include "shadow/frame/history.h"
#include "shadow/scene/bent_column.h"
#include "shadow/scene/rig.h"
#include "tests/rig.h"

#include <gtest/gtest.h>

namespace gn {
namespace {

constexpr uint width = 96, height = 64;

AnimatedScene column() {
    const testing_scene::TempFolder folder;
    return load_animated_scene(folder.write("column.gltf", testing_scene::bent_column()));
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

class Animated : public testing::TestWithParam<const char*> {};

TEST_P(Animated, ASkinTakesItsShadowAlong) {
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe(GetParam());
    AnimatedScene loaded = column();
    Scene& scene = loaded.scene;
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    FrameResult before = draw(gpu, recipe, &history);
    for (const double seconds : {0.5, 1.0}) {
        // What was kept knows of the bend: the frame is that of a scene that always stood so.
        pose_scene(scene, loaded.rig, find_animation(loaded.rig, "bend"), seconds);
        refresh_scene(test::device(), gpu);
        const FrameResult bent = draw(gpu, recipe, &history);
        SceneGpu anew = upload_scene(test::device(), scene);
        EXPECT_EQ(bent.samples.position_ws, draw(anew, recipe, nullptr).samples.position_ws);
        History empty(test::device());
        EXPECT_EQ(bent.visibility.front().values, draw(anew, recipe, &empty).visibility.front().values);

        // The truth bent likewise: against it the shadow of before is far off, by the samples that the bend crossed.
        const double error = error_against_truth(scene, bent);
        FrameResult left_behind = bent;
        left_behind.visibility = before.visibility;
        EXPECT_LT(2 * error, error_against_truth(scene, left_behind)) << error << " at " << seconds;
        before = bent;
    }
}

INSTANTIATE_TEST_SUITE_P(Recipes, Animated,
                         testing::Values("hard,placement=cascades,cascades.scroll=1,resolution=512", "volumes",
                                         "silhouette,resolution=512"),
                         [](const auto& test) {
                             const std::string text = test.param;
                             return text.substr(0, text.find(','));
                         });

}  // namespace
}  // namespace gn
