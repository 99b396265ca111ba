// SPDX-License-Identifier: MIT
// What an animation bends takes its shadow along: in maps that are kept, in volumes and edges, and in the truth alike.
#include "shadow/scene/bent_column.h"
#include "shadow/scene/rig.h"
#include "tests/moving.h"

#include <gtest/gtest.h>

namespace gn::animated_test {
namespace {

void expect_shadow_along(const char* text, const char* animation) {
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe(text);
    const testing_scene::TempFolder folder;
    AnimatedScene loaded = load_animated_scene(folder.write("column.gltf", testing_scene::bent_column(true)));
    Scene& scene = loaded.scene;
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    FrameResult before = test::draw_moving(gpu, recipe, &history);
    for (const double seconds : {0.5, 1.0}) {
        // What was kept knows of the bend: the frame is that of a scene that always stood so.
        pose_scene(scene, loaded.rig, find_animation(loaded.rig, animation), seconds);
        refresh_scene(test::device(), gpu);
        const FrameResult bent = test::draw_moving(gpu, recipe, &history);
        SceneGpu anew = upload_scene(test::device(), scene);
        EXPECT_EQ(bent.samples.position_ws, test::draw_moving(anew, recipe, nullptr).samples.position_ws);
        History empty(test::device());
        EXPECT_EQ(bent.visibility.front().values, test::draw_moving(anew, recipe, &empty).visibility.front().values);

        // The truth bent likewise: against it the shadow of before is far off, by the samples that the bend crossed.
        const double error = test::error_against_truth(scene, bent);
        FrameResult left_behind = bent;
        left_behind.visibility = before.visibility;
        EXPECT_LT(2 * error, test::error_against_truth(scene, left_behind)) << error << " at " << seconds;
        before = bent;
    }
}

class Animated : public testing::TestWithParam<const char*> {};

TEST_P(Animated, ASkinTakesItsShadowAlong) {
    expect_shadow_along(GetParam(), "bend");
}

TEST(Morphed, ItsShadowComesAlong) {
    expect_shadow_along("hard,placement=cascades,cascades.scroll=1,resolution=512", "lean");
}

INSTANTIATE_TEST_SUITE_P(Recipes, Animated,
                         testing::Values("hard,placement=cascades,cascades.scroll=1,resolution=512", "volumes",
                                         "silhouette,resolution=512"),
                         [](const auto& test) {
                             const std::string text = test.param;
                             return text.substr(0, text.find(','));
                         });

}  // namespace
}  // namespace gn::animated_test
