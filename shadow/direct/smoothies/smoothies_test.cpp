// SPDX-License-Identifier: MIT
#include "shadow/direct/smoothies/smoothies.glsl"

#include "tests/rig.h"

#include <gtest/gtest.h>

namespace gn::smoothies_test {
namespace {

TEST(SmoothiesLaws, light_rises_over_parkers_ratio_of_the_fin) {
    // A lamp's fin at 2 m before a receiver at 5 m: the penumbra takes 1 - 2/5 of it.
    EXPECT_EQ(gn_smoothies_light(0, 2, 5, true, {}), 0.0F);
    EXPECT_NEAR(gn_smoothies_light(0.3F, 2, 5, true, {}), 0.5F, 1e-6F);
    EXPECT_EQ(gn_smoothies_light(0.6F, 2, 5, true, {}), 1.0F);
    EXPECT_NEAR(gn_smoothies_light(0.15F, 2, 5, true, {.width = 0.5F}), 0.5F, 1e-6F);
    // A sun's is as long as the way behind the edge.
    EXPECT_NEAR(gn_smoothies_light(1.2F, 2, 5, false, {}), 0.4F, 1e-6F);
    EXPECT_EQ(gn_smoothies_light(3, 2, 5, false, {}), 1.0F);
    // Before the edge nothing is hidden, and at contact the edge is sharp.
    EXPECT_EQ(gn_smoothies_light(0, 2, 2, true, {}), 1.0F);
    EXPECT_EQ(gn_smoothies_light(0.01F, 2, 2.0001F, true, {}), 1.0F);
}

TEST(SmoothiesRendered, the_half_planes_umbra_is_its_hard_shadow_and_light_rises_beside_it) {
    for (const char* scene : {"half-plane:light=spot", "half-plane"}) {
        const test::Comparison c =
            test::compare(scene, "smoothies,resolution=1024", {.width = 96, .height = 96, .samples = 16});
        const GnLight& light = c.scene.lights.front().shape;
        const auto radius = static_cast<double>(light.kind == GN_LIGHT_SPOT ? light.radius : light.half_size.x);
        std::size_t wrong = 0, penumbra = 0;
        for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
            const dvec3 p_ws(c.frame.samples.position_ws[i]);
            if (c.truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-5) {
                continue;
            }
            // The light hangs 4 m above the floor and the edge 2 m, at x = 0: W = r 2 / (4 - 2).
            const double v = std::clamp(p_ws.x / radius, 0.0, 1.0);
            penumbra += v > 0 && v < 1 ? 1 : 0;
            // A texel is at most 16 m / 1024 of the floor.
            wrong += std::abs(v - static_cast<double>(c.visibility().values[i])) > 0.016 / radius ? 1 : 0;
        }
        EXPECT_GT(penumbra, 300U) << scene;
        EXPECT_EQ(wrong, 0U) << scene;
    }
}

}  // namespace
}  // namespace gn::smoothies_test
