// SPDX-License-Identifier: MIT
#include "shadow/map/msm/msm.glsl"

#include "scenes/analytic.h"
#include "tests/rig.h"

#include <random>

namespace gn::msm_test {
namespace {

using namespace gn::glsl;

constexpr GnMsmParams exact(int problem, float moment_bias) {
    return {.problem = problem, .format = GN_MSM_FLOAT32, .moment_bias = moment_bias, .bleeding = 0};
}

vec4 two_planes(float d1, float d2, float share1) {
    return share1 * gn_msm_moments(d1) + (1 - share1) * gn_msm_moments(d2);
}

TEST(Msm, QuantizationIsUndone) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 200; ++i) {
        const vec4 b = two_planes(uniform(random), uniform(random), uniform(random));
        const vec4 back = gn_msm_dequantize(gn_msm_quantize(b));
        for (int k = 0; k < 4; ++k) {
            EXPECT_NEAR(back[k], b[k], 2e-6) << "component " << k;
        }
    }
}

TEST(Msm, EveryQuantizedComponentFillsItsFormat) {
    // All of [0,1] is used and nothing is cut off; mixtures then stay inside by convexity.
    vec4 low(1);
    vec4 high(0);
    for (int i = 0; i <= 100000; ++i) {
        const vec4 q = gn_msm_quantize(gn_msm_moments(static_cast<float>(i) / 100000));
        low = min(low, q);
        high = max(high, q);
    }
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(low[k], 0, 1e-6) << "component " << k;
        EXPECT_NEAR(high[k], 1, 1e-6) << "component " << k;
    }
}

TEST(Msm, BiasedMomentsAreThoseOfAMixture) {
    // [PK15] eq. 5: what was there gives up a share to masses 0.315, 0.37, 0.315 at depths 0, 1/2, 1.
    for (const float amount : {0.0F, 0.01F, 0.4F, 1.0F}) {
        const vec4 masses = 0.315F * (gn_msm_moments(0) + gn_msm_moments(1)) + 0.37F * gn_msm_moments(0.5F);
        const vec4 b = two_planes(0.2F, 0.9F, 0.3F);
        EXPECT_LT(glm::distance(gn_msm_biased(b, amount), (1 - amount) * b + amount * masses), 1e-6F) << amount;
    }
}

TEST(Msm, TendsToTheExactShareOnTwoPlanes) {
    // Moments of two depths are on the border of all moments: only one distribution has them, so the bound is the share
    // itself. The bias moves them inside; with it the error goes.
    std::array<double, 3> worst{};
    const std::array<float, 3> biases{1e-2F, 1e-3F, 1e-4F};
    for (std::size_t i = 0; i < biases.size(); ++i) {
        for (const int problem : {GN_MSM_HAMBURGER, GN_MSM_HAUSDORFF}) {
            for (float share = 0.1F; share < 0.95F; share += 0.1F) {
                const vec4 b = two_planes(0.2F, 0.5F, share);
                const double v = gn_msm_visible(b, 0.8F, exact(problem, biases.at(i)));
                const double lit = gn_msm_visible(b, 0.35F, exact(problem, biases.at(i)));
                worst.at(i) = std::max({worst.at(i), v, std::abs(lit - (1 - share))});
            }
        }
    }
    EXPECT_LT(worst[1], worst[0]);
    EXPECT_LT(worst[2], worst[1]);
    EXPECT_LT(worst[2], 0.02);
}

TEST(Msm, BlockersOfTwoDepthsAreTheNearerOne) {
    // Three points have these moments once the bias moves them inside: one is the receiver, and the mean of those before it
    // tends to the depth that there is.
    for (float share = 0.1F; share < 0.95F; share += 0.1F) {
        const vec2 found = gn_msm_before(gn_msm_biased(two_planes(0.2F, 0.8F, share), 1e-4F), 2 * 0.7F - 1);
        EXPECT_NEAR(found.x, share, 0.02) << share;
        EXPECT_NEAR(0.5F + 0.5F * found.y, 0.2, 0.02) << share;
    }
}

TEST(Msm, IsNeverDarkerThanPercentageCloserFiltering) {
    // Hamburger's bound holds for every distribution, Hausdorff's for those in [0,1], and is the sharper.
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0, 1);
    double gain = 0;
    for (int i = 0; i < 2000; ++i) {
        const float receiver = uniform(random);
        vec4 mean(0);
        float lit = 0;
        for (int k = 0; k < 9; ++k) {
            const float depth = uniform(random);
            mean += gn_msm_moments(depth) / 9.0F;
            lit += receiver <= depth ? 1.0F / 9 : 0;
        }
        const float hamburger = gn_msm_visible(mean, receiver, exact(GN_MSM_HAMBURGER, 1e-5F));
        const float hausdorff = gn_msm_visible(mean, receiver, exact(GN_MSM_HAUSDORFF, 1e-5F));
        EXPECT_GE(hausdorff, lit - 2e-3) << "case " << i << " receiver " << receiver;
        EXPECT_LE(hausdorff, hamburger + 2e-3) << "case " << i << " receiver " << receiver;
        gain += hamburger - hausdorff;
    }
    EXPECT_GT(gain / 2000, 1e-3);
}

TEST(Msm, SixteenBitsChangeLittle) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform(0, 1);
    const auto rounded = [](float x) { return std::round(x * 65535.0F) / 65535.0F; };
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
        vec4 b(0);
        for (int k = 0; k < 9; ++k) {
            b += gn_msm_moments(uniform(random)) / 9.0F;
        }
        vec4 q = gn_msm_quantize(b);
        q = vec4(rounded(q.x), rounded(q.y), rounded(q.z), rounded(q.w));
        GnMsmParams params = exact(GN_MSM_HAMBURGER, 6e-5F);
        const float receiver = uniform(random);
        const float full = gn_msm_visible(b, receiver, params);
        params.format = GN_MSM_UNORM16;
        const double change = gn_msm_visible(q, receiver, params) - full;
        sum += change * change;
    }
    EXPECT_LT(std::sqrt(sum / 2000), 5e-3);
}

TEST(MsmRendered, TellsTheTwoCastersOfTheStackApart) {
    // Two depths under every kernel well inside the shadow of A and B on the floor: no light may bleed there.
    const auto bleeding = [](const std::string& recipe) {
        const auto c = test::compare("stack", recipe, {.samples = 1});
        double sum = 0;
        for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
            const vec4 p_ws = c.frame.samples.position_ws[i];
            const bool under_b = p_ws.w > 0.5F && p_ws.y < 1e-3F && std::abs(p_ws.x) < 0.8F && std::abs(p_ws.z) < 0.8F;
            sum += under_b ? c.visibility().values[i] : 0;
        }
        return sum;
    };
    for (const std::string placement : {",placement=fit", ",placement=cascades"}) {
        const double vsm = bleeding("vsm,resolution=512,vsm.bleeding=0" + placement);
        EXPECT_LT(bleeding("msm,resolution=512,msm.bleeding=0" + placement), 0.2 * vsm) << placement;
        EXPECT_LT(bleeding("msm,resolution=512,msm.bleeding=0,msm.format=float32,msm.moment_bias=1e-6" + placement),
                  0.1 * vsm)
            << placement;
    }
}

TEST(MsmRendered, StaysInRangeAndFreeOfAcne) {
    for (const char* options : {"", ",msm.problem=hausdorff", ",msm.format=float32,msm.samples=4",
                                ",msm.problem=hausdorff,msm.format=float32,msm.blur=gaussian"}) {
        const auto c = test::compare("tilted:angle=75", std::string("msm,resolution=512") + options,
                                     {.width = 96, .height = 96, .samples = 1});
        EXPECT_LE(*c.errors.acne, 0.01) << options;
        for (const float v : c.visibility().values) {
            ASSERT_TRUE(v >= 0 && v <= 1) << v << options;
        }
    }
}

}  // namespace
}  // namespace gn::msm_test
