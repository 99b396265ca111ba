// SPDX-License-Identifier: MIT
#include "shadow/visibility/bilateral/bilateral.glsl"

#include "scenes/analytic.h"
#include "tests/rig.h"

namespace gn::bilateral_test {
namespace {

using namespace gn::glsl;

TEST(Bilateral, WeightsAreOneInThePlaneAndFallOffIt) {
    const GnBilateralParams params;
    const vec3 p(1, 2, 3), n(0, 1, 0);
    EXPECT_EQ(gn_bilateral_spatial(0, 3), 1);
    EXPECT_EQ(gn_bilateral_range(p, n, 0.01F, p + vec3(5, 0, -2), n, params), 1);
    float before = 1;
    for (const float height : {0.01F, 0.02F, 0.05F, 0.1F}) {
        const float weight = gn_bilateral_range(p, n, 0.01F, p + vec3(0.1F, height, 0), n, params);
        EXPECT_LT(weight, before);
        before = weight;
    }
    // Ten pixels off the plane, or at a right angle: nothing.
    EXPECT_LT(before, 1e-5);
    EXPECT_EQ(gn_bilateral_range(p, n, 0.01F, p, vec3(1, 0, 0), params), 0);
    EXPECT_EQ(gn_bilateral_range(p, n, 0.01F, p, -n, params), 0);
}

TEST(BilateralRendered, ConstantVisibilityStaysConstant) {
    // An unoccluded plane is 1 everywhere the light counts, whatever the radius.
    for (const char* options : {"", ",bilateral.radius=64", ",bilateral.plane=0.01,bilateral.normal=1024"}) {
        const auto c = test::compare("tilted:angle=60", std::string("pcf-bilateral") + options,
                                     {.width = 96, .height = 96, .samples = 4});
        for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
            ASSERT_EQ(c.visibility().values[i], c.truth.counted[i] != 0 ? 1.0F : 0.0F) << options << " at " << i;
        }
    }
}

TEST(BilateralRendered, RadiusZeroIsNoFilter) {
    const test::ComparisonOptions size{.width = 96, .height = 96, .samples = 1};
    const auto filtered = test::compare("contact", "pcf-bilateral,bilateral.radius=0", size);
    const auto plain = test::compare("contact", "pcf-bilateral,visibility=none", size);
    EXPECT_EQ(filtered.visibility().values, plain.visibility().values);
}

TEST(BilateralRendered, NothingBleedsOverADepthDiscontinuity) {
    // B hides C: along B's rim on screen lit samples of B lie beside dark ones of C, and hard shadows are far from it.
    const test::ComparisonOptions size{.width = 192, .height = 192, .samples = 1};
    const auto hard = test::compare("stack", "hard,resolution=2048", size);
    const auto soft = test::compare("stack", "hard,resolution=2048,visibility=bilateral,bilateral.radius=8", size);
    const auto& p_ws = hard.frame.samples.position_ws;
    const auto& v = hard.visibility().values;
    std::size_t rim = 0;
    for (int y = 8; y < 184; ++y) {
        for (int x = 8; x < 184; ++x) {
            // Take samples whose own surface is of one visibility as far as the kernel reaches, with the other beside.
            const auto i = static_cast<std::size_t>(y * 192 + x);
            bool own_is_constant = true, other_differs = false;
            for (int k = -8; k <= 8 && p_ws[i].w > 0.5F; ++k) {
                for (int l = -8; l <= 8; ++l) {
                    const auto j = static_cast<std::size_t>((y + k) * 192 + x + l);
                    const bool same_surface = p_ws[j].w > 0.5F && std::abs(p_ws[j].y - p_ws[i].y) < 1e-2F;
                    own_is_constant = own_is_constant && (!same_surface || v[j] == v[i]);
                    other_differs = other_differs || (!same_surface && p_ws[j].w > 0.5F && v[j] != v[i]);
                }
            }
            if (p_ws[i].w > 0.5F && own_is_constant && other_differs && hard.truth.counted[i] != 0) {
                ++rim;
                ASSERT_NEAR(soft.visibility().values[i], v[i], 1e-4) << x << ", " << y;
            }
        }
    }
    EXPECT_GT(rim, 100U);
}

TEST(BilateralRendered, LessNoiseThanTheLookupAlone) {
    const test::ComparisonOptions size{.width = 480, .height = 360, .samples = 32};
    const auto noisy = test::compare("courtyard", "pcf-bilateral,visibility=none", size);
    const auto filtered = test::compare("courtyard", "pcf-bilateral", size);
    EXPECT_LT(*filtered.errors.rmse, *noisy.errors.rmse);
    EXPECT_LT(*filtered.errors.penumbra, *noisy.errors.penumbra);

    // Against many taps treated alike, so that the filter's own blur is on both sides: the mean of two independent samples
    // has half the variance of one, and in these penumbrae no sample has fewer than one of its like beside it.
    const auto variance = [&](const test::Comparison& few, const std::string& more) {
        const auto many = test::compare("courtyard", "pcf-bilateral,pcf.taps=64" + more, size);
        const double rmse =
            *visibility_errors(few.visibility().values, many.visibility().values, few.truth.counted, 480, 360).rmse;
        return rmse * rmse;
    };
    EXPECT_LT(variance(filtered, ""), 0.5 * variance(noisy, ",visibility=none"));
}

}  // namespace
}  // namespace gn::bilateral_test
