// SPDX-License-Identifier: MIT
#include "shadow/map/vsm/vsm.glsl"

#include "scenes/analytic.h"
#include "tests/rig.h"

#include <random>

namespace gn::vsm_test {
namespace {

using namespace gn::glsl;

vec2 moments_of(float d1, float d2, float share1) {
    const vec2 a = gn_vsm_moments(d1, 0);
    const vec2 b = gn_vsm_moments(d2, 0);
    return share1 * a + (1 - share1) * b;
}

TEST(Vsm, MomentsOfATexelAreThoseOfItsPlane) {
    // [DL06] 4.1 takes the texel for a Gaussian of half its side: the mean square over points half a texel to either side.
    const float d = 0.4F, ddx = 0.03F, ddy = -0.05F;
    float square = 0;
    for (const vec2 at : {vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1)}) {
        const float depth = d + 0.5F * (at.x * ddx + at.y * ddy);
        square += 0.25F * depth * depth;
    }
    EXPECT_EQ(gn_vsm_moments(d, gn_vsm_spread(ddx, ddy)).x, d);
    EXPECT_NEAR(gn_vsm_moments(d, gn_vsm_spread(ddx, ddy)).y, square, 1e-7);
}

TEST(Vsm, BoundIsExactOnParallelPlanes) {
    // [Lau08] 3.2: a share p of the kernel sees the receiver's plane d2, the rest the occluder's plane d1: V = p.
    for (float share = 0.05F; share < 1; share += 0.05F) {
        const vec2 moments = moments_of(0.3F, 0.7F, 1 - share);
        EXPECT_NEAR(gn_vsm_chebyshev(moments, 0.7F, 0), share, 1e-5);
    }
}

TEST(Vsm, BlockersOfTwoDepthsAreTheNearerOne) {
    // A share of the kernel sees the occluder's plane, the rest the receiver's own: both are found as they are.
    for (float share = 0.05F; share < 1; share += 0.05F) {
        const vec2 found = gn_vsm_found(moments_of(0.3F, 0.7F, share), 0.7F, 0);
        EXPECT_NEAR(found.x, share, 1e-5);
        EXPECT_NEAR(found.y, 0.3F, 1e-4) << share;
    }
    EXPECT_EQ(gn_vsm_found(moments_of(0.7F, 0.9F, 0.5F), 0.7F, 0).x, 0) << "nothing lies before it";
}

TEST(Vsm, BoundIsNeverBelowPercentageCloserFiltering) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 500; ++i) {
        vec2 mean(0);
        float lit = 0;
        const float receiver = uniform(random);
        for (int k = 0; k < 9; ++k) {
            const float depth = uniform(random);
            mean += gn_vsm_moments(depth, 0) / 9.0F;
            lit += receiver <= depth ? 1.0F / 9 : 0;
        }
        EXPECT_GE(gn_vsm_chebyshev(mean, receiver, 0), lit - 1e-4);
    }
}

TEST(Vsm, BleedingOfThreePlanesFollowsTheEquation) {
    // A over half the kernel, B under it, C below: what passes B reaches C although B hides it all.
    using namespace scenes::stack_scene;
    const double near = 10;  // metres from the light to A; any
    const auto depth = [&](double y) { return static_cast<float>((near + height_a - y) / 20); };
    const vec2 moments = moments_of(depth(height_a), depth(height_b), 0.5F);
    EXPECT_NEAR(gn_vsm_chebyshev(moments, depth(height_c), 0), bleeding(dy), 1e-3);
}

TEST(Vsm, ReductionKeepsTheEndsAndTheOrder) {
    EXPECT_EQ(gn_vsm_reduce_bleeding(1, 0.3F), 1);
    EXPECT_EQ(gn_vsm_reduce_bleeding(0.3F, 0.3F), 0);
    EXPECT_EQ(gn_vsm_reduce_bleeding(0.1F, 0.3F), 0);
    EXPECT_LT(gn_vsm_reduce_bleeding(0.5F, 0.3F), gn_vsm_reduce_bleeding(0.6F, 0.3F));
}

/// [Lau08] eq. 3.4 for any share s of the kernel over A, the rest over B; the equation itself has s = 1/2.
double bleeding_at(double s) {
    using namespace scenes::stack_scene;
    const double variance = s * (1 - s) * dx * dx;
    const double distance = dy + s * dx;
    return variance / (variance + distance * distance);
}

TEST(Vsm, BleedsMostWhereTheNearerCasterCoversItsShareOfTheDistances) {
    // The derivative of bleeding_at is zero where (dx^2 + 2 dx dy) s^2 + 2 dy^2 s = dy^2, at s = dy / (dx + 2 dy).
    using namespace scenes::stack_scene;
    const double s = worst_share(dy);
    EXPECT_NEAR(bleeding_at(s), worst_bleeding(dy), 1e-12);
    EXPECT_NEAR(worst_bleeding(dy), 0.093, 5e-4);
    for (double other = 0; other <= 1; other += 1.0 / 64) {
        EXPECT_LE(bleeding_at(other), worst_bleeding(dy) + 1e-12) << other;
    }
}

/// The most light on C well under B, for a kernel of 17 texels.
double most_under_b(const std::string& more) {
    const auto c = test::compare(
        "stack", "vsm,vsm.bleeding=0,vsm.min_deviation=0,vsm.radius=8,vsm.mipmaps=false,resolution=1024" + more,
        {.width = 384, .height = 384, .view = "under"});
    double most = 0;
    int samples = 0;
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const vec4 p_ws = c.frame.samples.position_ws[i];
        if (p_ws.w > 0.5F && p_ws.y < 1e-3F && std::abs(p_ws.x) < 0.6F && std::abs(p_ws.z) < 0.6F) {
            most = std::max(most, static_cast<double>(c.visibility().values[i]));
            ++samples;
        }
    }
    EXPECT_GT(samples, 500) << more;
    return most;
}

TEST(VsmRendered, BleedingOnTheStackFollowsTheEquation) {
    EXPECT_NEAR(bleeding_at(0.5), scenes::stack_scene::bleeding(scenes::stack_scene::dy), 1e-12);

    // A kernel of 17 texels wanders over the edge of A, and bilinear fetches take every share of it: well under B the most
    // that reaches C is the closed form's most. The map holds A and B at their own depths, so it must not be fitted to the
    // receivers, which would clamp both; cascades keep the depths of the whole scene.
    const double expected = scenes::stack_scene::worst_bleeding(scenes::stack_scene::dy);
    for (const std::string placement : {"single", "cascades"}) {
        EXPECT_NEAR(most_under_b(",placement=" + placement), expected, 2e-3) << placement;
    }
}

/// Squares leave no gap, end where the box does, and one alone is a box whose side is a power of two.
TEST(Vsm, SquaresCoverABoxFromEndToEnd) {
    const vec4 bounds(16, 0, 80, 64);
    for (const vec2 side : {vec2(1), vec2(4), vec2(5.5F, 7), vec2(8, 20), vec2(3, 17), vec2(64), vec2(300, 40)}) {
        for (const vec2 middle : {vec2(40, 30), vec2(17, 63)}) {
            const GnVsmSquares over = gn_vsm_squares_over(middle, side, bounds, 7);
            const auto square = static_cast<float>(1 << over.level);
            const vec2 within = min(side, vec2(64));
            for (int c = 0; c < 2; ++c) {
                const float reach = over.apart[c] * static_cast<float>(over.count[c] - 1) + square;
                EXPECT_LE(over.apart[c], square) << side[c];
                EXPECT_NEAR(reach, std::max(within[c], square), 1e-3F);
                EXPECT_GE(over.first[c], bounds[c]);
                EXPECT_LE(over.first[c] + reach, bounds[c + 2] + 1e-3F);
            }
        }
    }
    EXPECT_EQ(gn_vsm_squares_over(vec2(40), vec2(3, 17), bounds, 7).level, 2)
        << "eight squares of two are no 17 texels";
    EXPECT_EQ(gn_vsm_squares_over(vec2(40), vec2(16), bounds, 7).count, ivec2(1));
    EXPECT_EQ(gn_vsm_squares_over(vec2(40), vec2(16), bounds, 7).first, vec2(32));
    EXPECT_EQ(gn_vsm_squares_over(vec2(40), vec2(17), bounds, 7).count, ivec2(2));
}

TEST(Vsm, TheSpreadOfAPlaneIsNoMoreThanItsDepthAllows) {
    // Depths lie in [0,1], as far to one side of their mean as to the other: their variance is at most the square of the
    // way to the nearer end.
    for (const float depth : {0.0F, 0.01F, 0.3F, 0.9F, 1.0F}) {
        const float room = std::min(depth, 1 - depth);
        EXPECT_NEAR(gn_vsm_moments(depth, gn_vsm_spread(50, 50)).y, depth * depth + room * room, 1e-6F) << depth;
        EXPECT_NEAR(gn_vsm_moments(depth, gn_vsm_spread(0.01F * room, 0)).y, depth * depth + 0.25e-4F * room * room,
                    1e-6F)
            << depth;
    }
}

TEST(VsmRendered, MostVarianceAndSmoothReductionDarkenWhatBleeds) {
    // A smooth step of the worst bleeding v is v^2 (3 - 2 v); the limit is where nothing varies more, and little below it.
    const double v = scenes::stack_scene::worst_bleeding(scenes::stack_scene::dy);
    EXPECT_NEAR(most_under_b(",placement=single,vsm.reduction=smoothstep"), v * v * (3 - 2 * v), 2e-3);
    EXPECT_NEAR(most_under_b(",placement=single,vsm.max_deviation=0.5"), v, 2e-3);
    EXPECT_LT(most_under_b(",placement=single,vsm.max_deviation=0.01"), 0.5 * v);
}

TEST(VsmRendered, StaysInRangeAndFreeOfAcneAtTheDefaults) {
    for (const char* options :
         {"", ",vsm.samples=4", ",vsm.blur=gaussian,vsm.radius=5", ",vsm.mipmaps=false,vsm.blur=none"}) {
        const auto c =
            test::compare("tilted:angle=75", std::string("vsm,resolution=512") + options, {.width = 96, .height = 96});
        // The mean of a kernel on a plane is the receiver's own depth but for rounding e, which takes e^2 / sigma^2 of the
        // light: with the deviation of a texel or more, 1e-3 of the range, and 1e-6 of rounding next to nothing.
        EXPECT_LE(*c.errors.acne, 1e-4) << options;
        for (const float v : c.visibility().values) {
            ASSERT_TRUE(v >= 0 && v <= 1) << v;
        }
    }
}

}  // namespace
}  // namespace gn::vsm_test
