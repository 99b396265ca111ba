// SPDX-License-Identifier: MIT
#include "shadow/direct/split_volumes/split_volumes.glsl"
#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

namespace gn {
namespace parts {
const Part& direct_volumes();
const Part& direct_split_volumes();
}  // namespace parts
namespace split_volumes_test {
namespace {

using namespace by_hand;

std::vector<std::vector<float>> visibility(const Scene& scene, const Recipe& recipe) {
    SceneGpu uploaded = upload_scene(device(), scene);
    const FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), recipe,
                                           {.width = 160, .height = 120, .picture = false});
    std::vector<std::vector<float>> images;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        EXPECT_EQ(frame.refused[i], "");
        images.push_back(frame.visibility[i].values);
    }
    return images;
}

TEST(SplitVolumes, a_tile_splits_where_near_and_far_are_as_far_off) {
    EXPECT_FLOAT_EQ(gn::glsl::gn_split_volumes_depth(0.5F, 0.125F), 0.25F);
    int heads = 0;
    for (int i = 0; i < 10000; ++i) {
        heads += gn::glsl::gn_split_volumes_coin(ivec2(i % 100, i / 100)) ? 1 : 0;
    }
    EXPECT_NEAR(heads, 5000, 4 * 50);  // four deviations of so many coins
}

TEST(SplitVolumes, whichever_side_is_counted_the_picture_is_that_of_volumes) {
    // From the light and, where boxes shade the near rectangle, from the shadow.
    for (const vec3 eye : {vec3(3, 4.6F, 4.2F), vec3(0.4F, 0.8F, 0.1F)}) {
        SceneBuilder b;
        b.ground(10).box({-1, 1, -1}, {1, 1.5F, 1}).torus({0.3F, 2.6F, 0.2F}, 1.1F, 0.4F, 12);
        b.soup({{-3, 0.2F, -3}, {1, 2, 0}}, 0.7F, 30, 3).camera(eye, {-2.2F, 0.1F, 0.3F});
        b.light(sun({-0.4F, -1, 0.33F})).light(point({0.3F, 3.8F, 0.7F})).light(rectangle({2.5F, 5, 4.2F}, {0, 0, 0}));
        const Scene scene = b.scene();
        const auto expected = visibility(scene, direct_recipe(parts::direct_volumes(), {{"mode", "z-fail"}}));
        for (const char* split : {"depth", "random"}) {
            EXPECT_EQ(visibility(scene, direct_recipe(parts::direct_split_volumes(), {{"split", split}})), expected)
                << split << " from " << eye.x;
        }
        EXPECT_GT(std::count(expected[0].begin(), expected[0].end(), 0.0F), 500);
        EXPECT_GT(std::count(expected[0].begin(), expected[0].end(), 1.0F), 500);
    }
}

}  // namespace
}  // namespace split_volumes_test
}  // namespace gn
