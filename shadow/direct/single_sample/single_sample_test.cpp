// SPDX-License-Identifier: MIT
#include "shadow/direct/single_sample/single_sample.glsl"

#include "tests/rig.h"

#include <gtest/gtest.h>

#include <numbers>

namespace gn::single_sample_test {
namespace {

TEST(SingleSampleLaws, both_profiles_are_nearly_the_discs) {
    double sine = 0, cubic = 0;
    for (double tau = 0; tau <= 1; tau += 1e-4) {
        const double t = 2 * tau - 1;
        const double disc = 0.5 + (t * std::sqrt(std::max(0.0, 1 - t * t)) + std::asin(t)) / std::numbers::pi;
        sine = std::max(sine, std::abs(disc - static_cast<double>(glsl::gn_single_sample_light(
                                                  static_cast<float>(tau), GN_SINGLE_SAMPLE_SINE))));
        cubic = std::max(cubic, std::abs(disc - static_cast<double>(glsl::gn_single_sample_light(
                                                    static_cast<float>(tau), GN_SINGLE_SAMPLE_CUBIC))));
    }
    EXPECT_NEAR(sine, 0.0491, 5e-5);
    EXPECT_NEAR(cubic, 0.0394, 5e-5);
}

TEST(SingleSampleRendered, the_half_planes_penumbra_lies_wholly_outside_its_hard_shadow) {
    const test::Comparison c =
        test::compare("half-plane:light=spot", "single-sample", {.width = 96, .height = 96, .samples = 16});
    const GnLight& light = c.scene.lights.front().shape;
    ASSERT_GT(light.radius, 0.0F);
    std::size_t wrong = 0, penumbra = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-5) {
            continue;
        }
        // The light hangs 4 m above the floor and the edge 2 m, at x = 0: W = 2 r (4 - 2) / 2.
        const double tau = p_ws.x / static_cast<double>(2 * light.radius);
        const double v = tau <= 0 ? 0 : tau >= 1 ? 1 : tau * tau * (3 - 2 * tau);
        penumbra += v > 0 && v < 1 ? 1 : 0;
        wrong += std::abs(v - static_cast<double>(c.visibility().values[i])) > 1e-3 ? 1 : 0;
    }
    EXPECT_GT(penumbra, 500U);
    EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace gn::single_sample_test
