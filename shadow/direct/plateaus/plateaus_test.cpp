// SPDX-License-Identifier: MIT
#include "shadow/direct/plateaus/plateaus.glsl"

#include "tests/rig.h"

#include <gtest/gtest.h>

namespace gn::plateaus_test {
namespace {

TEST(PlateausLaws, light_rises_from_the_edge_to_its_width) {
    const vec3 a(0, 0, 0), b(2, 0, 0);
    for (float t = 0; t <= 1; t += 0.25F) {
        const float w = 0.5F + t * 0.5F;
        for (float x = 0; x <= 1; x += 0.125F) {
            const vec3 p = a + t * (b - a) + vec3(0, 0, x * w);
            EXPECT_NEAR(glsl::gn_plateaus_light(p, a, 0.5F, b, 1), x, 1e-6F);
        }
        EXPECT_EQ(glsl::gn_plateaus_light(a + t * (b - a) + vec3(0, 0, 1.01F * w), a, 0.5F, b, 1), 1.0F);
    }
    // Cones around the ends.
    EXPECT_NEAR(glsl::gn_plateaus_light({2.6F, 0, 0.8F}, a, 0.5F, b, 2), 0.5F, 1e-6F);
    EXPECT_NEAR(glsl::gn_plateaus_light({-0.15F, 0, -0.2F}, a, 0.5F, b, 2), 0.5F, 1e-6F);
}

TEST(PlateausLaws, an_edge_is_cut_between_plane_and_light) {
    const vec4 plane(0, 1, 0, 0), light(0, 4, 0, 1);
    vec3 a(0, -1, 0), b(0, 7, 0);
    ASSERT_TRUE(glsl::gn_plateaus_cut(plane, light, a, b));
    EXPECT_NEAR(a.y, 0, 1e-6F);
    EXPECT_NEAR(b.y, 3.8F, 1e-5F);
    EXPECT_NEAR(glsl::gn_plateaus_width(plane, light, 0.5F, {0, 2, 0}), 0.5F, 1e-6F);
    a = vec3(0, -2, 0);
    b = vec3(1, -1, 0);
    EXPECT_FALSE(glsl::gn_plateaus_cut(plane, light, a, b));
}

TEST(PlateausRendered, the_half_planes_umbra_is_its_hard_shadow_and_light_rises_beside_it) {
    const test::Comparison c =
        test::compare("half-plane:light=spot", "plateaus", {.width = 96, .height = 96, .samples = 16});
    const auto radius = static_cast<double>(c.scene.lights.front().shape.radius);
    std::size_t wrong = 0, penumbra = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-5) {
            continue;
        }
        // The light hangs 4 m above the floor and the edge 2 m, at x = 0: W = r 2 / (4 - 2).
        const double v = std::clamp(p_ws.x / radius, 0.0, 1.0);
        penumbra += v > 0 && v < 1 ? 1 : 0;
        // But for the pixel in which the rasterizer puts the edge.
        wrong += std::abs(v - static_cast<double>(c.visibility().values[i])) > 1e-3 ? 1 : 0;
    }
    EXPECT_GT(penumbra, 300U);
    EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace gn::plateaus_test
