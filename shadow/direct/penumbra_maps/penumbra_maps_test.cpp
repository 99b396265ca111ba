// SPDX-License-Identifier: MIT
#include "shadow/direct/penumbra_maps/penumbra_maps.glsl"

#include "tests/rig.h"

#include <gtest/gtest.h>

namespace gn::penumbra_maps_test {
namespace {

TEST(PenumbraMapsLaws, intensity_is_the_cones_depth_behind_the_vertex_over_the_surfaces) {
    // A vertex at 2 m before a surface at 5 m: the cone leaves at z_F = 2 / (1 - off), and W is off = 1 - 2/5.
    EXPECT_EQ(gn_penumbra_maps_light(0, 2, 5, true), 0.0F);
    EXPECT_NEAR(gn_penumbra_maps_light(0.3F, 2, 5, true), (2 / 0.7F - 2) / 3, 1e-6F);
    EXPECT_NEAR(gn_penumbra_maps_light(0.5999F, 2, 5, true), 1, 1e-3F);
    EXPECT_EQ(gn_penumbra_maps_light(0.61F, 2, 5, true), 1.0F);
    EXPECT_EQ(gn_penumbra_maps_light(2, 2, 5, true), 1.0F);
    EXPECT_NEAR(gn_penumbra_maps_light(1.2F, 2, 5, false), 0.4F, 1e-6F);
    EXPECT_EQ(gn_penumbra_maps_light(0.1F, 2, 2, true), 1.0F);
}

TEST(PenumbraMapsRendered, the_half_planes_umbra_is_its_hard_shadow_and_light_rises_beside_it) {
    const test::Comparison c =
        test::compare("half-plane:light=spot", "penumbra-maps", {.width = 96, .height = 96, .samples = 16});
    const auto radius = static_cast<double>(c.scene.lights.front().shape.radius);
    std::size_t wrong = 0, penumbra = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-5) {
            continue;
        }
        // The light hangs 4 m above the floor and the edge 2 m, at x = 0: off = x / 2 r, z_V = z_P - z_V = 2, W = r.
        const double off = p_ws.x / (2 * radius);
        const double v = off <= 0 ? 0 : off >= 0.5 ? 1 : off / (1 - off);
        penumbra += v > 0 && v < 1 ? 1 : 0;
        // A texel is at most 16 m / 1024 of the floor, where light rises by at most 2 / r a metre.
        wrong += std::abs(v - static_cast<double>(c.visibility().values[i])) > 2 * 0.016 / radius ? 1 : 0;
    }
    EXPECT_GT(penumbra, 300U);
    EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace gn::penumbra_maps_test
