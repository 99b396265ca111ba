// SPDX-License-Identifier: MIT
#include "shadow/direct/wedges/wedges.glsl"

#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

namespace gn::wedges_test {
namespace {

using namespace by_hand;

/// A rectangle of half width r, one metre above an edge along z under its centre, and a floor `drop` metres below: V at x from
/// the hard plane by the wedge, and the truth, a ramp over the width 2 r drop.
struct Ramp {
    double worst = 0;
    explicit Ramp(float r, float drop, int turn) {
        GnLight light = rectangle({0, 1, 0}, {0, 0, 0});
        light.right_ws = vec4(1, 0, 0, 0);
        light.up_ws = vec4(0, 0, 1, 0);
        light.half_size = {r, 0.5F};
        // The caster lies where x < 0: the edge runs so that its lit side is x > 0.
        vec3 a_ws(0, 0, -50);
        vec3 b_ws(0, 0, 50);
        if (glsl::gn_lit_side(a_ws - vec3(1, -1, 0), b_ws - vec3(1, -1, 0), vec3(light.position_ws) - vec3(1, -1, 0)) <
            0) {
            std::swap(a_ws, b_ws);
        }
        const glsl::GnWedge wedge = glsl::gn_wedge(light, a_ws, b_ws, turn);
        for (double x = -2; x <= 2; x += 0.001) {
            const float hard = x > 0 ? 1.0F : 0.0F;
            const float v = hard - glsl::gn_wedge_hidden(wedge, vec3(static_cast<float>(x), -drop, 0.1F));
            const double truth = std::clamp(0.5 + x / static_cast<double>(2 * r * drop), 0.0, 1.0);
            worst = std::max(worst, std::abs(static_cast<double>(v) - truth));
        }
    }
};

TEST(WedgesLaws, planes_turned_by_the_arctangent_are_exact_above_a_parallel_edge) {
    for (const float r : {0.05F, 1.0F / 6, 0.5F}) {
        EXPECT_LT(Ramp(r, 1.3F, GN_WEDGES_ATAN).worst, 2e-5) << r;
    }
}

TEST(WedgesLaws, planes_that_touch_the_sphere_err_as_derived) {
    // The ramp is wider by 1 / sqrt(1 - (R/D)^2), and errs most where the true one ends: (1 - sqrt(1 - (R/D)^2)) / 2.
    EXPECT_NEAR(Ramp(1.0F / 6, 1.3F, GN_WEDGES_ASIN).worst, 0.007, 0.0005);
    EXPECT_NEAR(Ramp(0.5F, 1.3F, GN_WEDGES_ASIN).worst, 0.067, 0.0005);
}

TEST(WedgesRendered, the_half_plane_has_its_ramp) {
    const test::Comparison c =
        test::compare("half-plane", "wedges,wedges.turn=atan", {.width = 96, .height = 96, .samples = 16});
    std::size_t wrong = 0, penumbra = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-5) {
            continue;
        }
        const double v = *c.scene.closed_form(0, p_ws);
        penumbra += v > 0 && v < 1 ? 1 : 0;
        // Sums of 16 bits round by 1/2048; a pixel on the hard plane itself may take either side of it.
        wrong += std::abs(v - static_cast<double>(c.visibility().values[i])) > 0.002 ? 1 : 0;
    }
    EXPECT_GT(penumbra, 500U);
    EXPECT_LE(wrong, 3U);
}

}  // namespace
}  // namespace gn::wedges_test
