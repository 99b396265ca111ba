// SPDX-License-Identifier: MIT
// Kernels that may leave their view, where they have no need to: not a bit of V is another one.
#include "tests/rig.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace gn::map_access_test {
namespace {

LightViews place_crossing(const FrameInput& input, const Recipe& recipe) {
    LightViews views = find_part(Stage::placement, "fit").place(input, recipe);
    views.crosses = true;
    return views;
}

std::vector<float> visibility(SceneGpu& gpu, const Recipe& recipe) {
    const FrameResult frame =
        render_frame(test::device(), gpu, gpu.scene->camera(""), recipe,
                     {.width = 96, .height = 64, .only_light = 0, .samples = false, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return frame.visibility.front().values;
}

TEST(MapAccess, WhatCrossesNothingReadsWhatItReadBefore) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), test::built_in("contact"));
    for (const char* lookup :
         {"hard", "pcf,pcf.kernel=gaussian,pcf.size=9", "pcf,pcf.kernel=vogel,pcf.taps=16,pcf.radius=5",
          "vsm,filtered.footprint=radius,filtered.radius=7", "pcss", "chs", "vssm"}) {
        // One view, wider than the kernel by its guard.
        Recipe recipe = load_recipe(std::string(lookup) + ",placement=fit,resolution=256");
        const std::vector<float> within = visibility(gpu, recipe);
        Part crossing = *recipe.placement;
        crossing.place = place_crossing;
        recipe.placement = &crossing;
        EXPECT_EQ(visibility(gpu, recipe), within) << lookup;
        EXPECT_GT(std::count_if(within.begin(), within.end(), [](float v) { return v < 0.5F; }), 50) << lookup;
    }
}

}  // namespace
}  // namespace gn::map_access_test
