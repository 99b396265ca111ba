// SPDX-License-Identifier: MIT
// Who counts where the light only grazes: shaders, truth and metrics draw the same line.
#include "tests/direct_scenes.h"
#include "tests/rig.h"

namespace gn::counted_test {
namespace {

TEST(Counted, GrazingSurfacesDoNotCount) {
    GnLight sun;
    for (const auto& [cosine, counts] : {std::pair{1.02F, true}, {0.98F, false}, {1e-5F, false}, {-1.0F, false}}) {
        const float sine = cosine * 0x1p-10F;
        EXPECT_EQ(gn_counted(sun, vec3(0), vec3(std::sqrt(1 - sine * sine), sine, 0)), counts) << cosine;
    }
    // The same line for lamps, at whatever distance.
    GnLight lamp;
    lamp.kind = GN_LIGHT_POINT;
    lamp.position_ws = vec4(0, 1e-3F, 0, 1);
    EXPECT_TRUE(gn_counted(lamp, vec3(1.0F, 0, 0), vec3(0, 1, 0)));
    EXPECT_FALSE(gn_counted(lamp, vec3(1.1F, 0, 0), vec3(0, 1, 0)));
}

/// A block and a fence of turned posts on a ground, under a sun in the zenith, seen from above and aside.
Scene noon() {
    by_hand::SceneBuilder builder;
    builder.ground(6);
    for (int i = 0; i < 12; ++i) {
        // Upright walls at all angles: whether they face the zenith is a matter of their last bits.
        const float angle = 0.37F * static_cast<float>(i);
        const vec3 along(0.5F * std::cos(angle), 0, 0.5F * std::sin(angle));
        const vec3 foot(static_cast<float>(i % 4) * 2.5F - 3.7F, 0, static_cast<float>(i / 4) * 2.3F - 2.9F);
        const vec3 up(0, 2, 0);
        builder.quad(foot - along, foot + along, foot + along + up, foot - along + up);
    }
    builder.box({-1, 1, -1}, {1, 1.3F, 1});
    // The cosine of 90 degrees in floats is not zero.
    GnLight zenith = by_hand::sun({0, -1, 0});
    zenith.direction_ws.x = 4.371139e-8F;
    builder.light(zenith);
    builder.camera({5, 6, 7}, {0, 0.5F, 0}, 0.1F, 50);
    Scene scene = builder.scene();
    finish_scene(scene);
    return scene;
}

TEST(Counted, WallsUnderAZenithSunAreNoErrorOfAnybody) {
    for (const char* recipe : {"pcf", "volumes", "planar"}) {
        const test::Comparison c = test::compare(noon(), recipe, {.width = 128, .height = 128, .samples = 1});
        std::size_t walls = 0;
        for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
            const bool upright = std::abs(c.frame.samples.normal_ws[i].y) < 0.5F;
            walls += upright && c.truth.counted[i] != 0 ? 1U : 0U;
            EXPECT_TRUE(c.truth.counted[i] != 0 || c.visibility().values[i] == 0.0F) << recipe << ", sample " << i;
        }
        EXPECT_EQ(walls, 0U) << recipe;
    }
    // What is left is the filter's width at the edges of two shadows; measured 0.033.
    EXPECT_LT(test::compare(noon(), "pcf", {.width = 128, .height = 128, .samples = 1}).errors.rmse.value(), 0.05);
}

}  // namespace
}  // namespace gn::counted_test
