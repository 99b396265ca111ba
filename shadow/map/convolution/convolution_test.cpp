// SPDX-License-Identifier: MIT
#include "shadow/map/convolution/convolution.glsl"

#include "tests/rig.h"

#include <array>
#include <random>

namespace gn::convolution_test {
namespace {

using namespace gn::glsl;

constexpr std::array<int, 5> term_counts{1, 2, 4, 8, 16};

/// V of a kernel of depths, the basis rounded to 8 bits as the map stores it.
float visible(const std::vector<float>& depths, float receiver, const GnConvolutionParams& params) {
    const float at = gn_convolution_receiver(receiver, params);
    float sum = 0;
    for (int group = 0; group < gn_convolution_groups(params.terms); ++group) {
        vec4 mean(0);
        for (const float depth : depths) {
            const vec4 stored = gn_convolution_encode(depth, group, params.span);
            mean += round(stored * 255.0F) / 255.0F / static_cast<float>(depths.size());
        }
        sum += gn_convolution_group(mean, at, group, params);
    }
    return gn_convolution_step(sum, params.scale);
}

TEST(Convolution, StoresNothingOutsideItsFormat) {
    for (float depth = 0; depth <= 1; depth += 0.01F) {
        const vec4 stored = gn_convolution_encode(depth, 7, 1);
        for (int k = 0; k < 4; ++k) {
            EXPECT_TRUE(stored[k] >= 0 && stored[k] <= 1) << stored[k];
        }
    }
}

TEST(Convolution, IsOneHalfOnTheStepWithoutOffset) {
    for (const int terms : term_counts) {
        const GnConvolutionParams params{.terms = terms, .offset = 0, .scale = 1};
        // Half a unit of 255 a term, by weights that sum to 1.3, of a value that spans two units.
        EXPECT_NEAR(visible({0.5F}, 0.5F, params), 0.5F, 2 * 1.3 * 0.5 / 255) << terms << " terms";
    }
}

TEST(Convolution, AScaleOfTwoMakesTheStepItselfLit) {
    // [EASW09] 4.2.3: the value is scaled, so that the one half that a surface has on itself becomes one.
    EXPECT_EQ(gn_convolution_step(0, 2), 1.0F);
    EXPECT_EQ(gn_convolution_step(0, 1), 0.5F);
    EXPECT_EQ(gn_convolution_step(-0.5F, 2), 0.0F);
    EXPECT_NEAR(gn_convolution_step(-0.25F, 2), 0.5F, 1e-6F);
}

TEST(Convolution, AnOffsetMovesTheReceiverTowardsTheLight) {
    // Half widths of the ramp: at one the surface itself is lit, and what lies one before it was lit already.
    const GnConvolutionParams params{.attenuation = 0, .offset = 1, .scale = 1};
    EXPECT_GT(visible({0.5F}, 0.5F, params), 0.95F);
    EXPECT_LT(gn_convolution_receiver(0.5F, params), 0.5F * params.span);
}

TEST(Convolution, AttenuationTakesTheRingingOffAStep) {
    // Beside the jump a truncated series swings past what it stands for, by 9 % of it (Gibbs).
    const auto overshoot = [](float attenuation) {
        const GnConvolutionParams params{.terms = 16, .attenuation = attenuation, .offset = 0, .scale = 1};
        float most = 0;
        for (float depth = 0.45F; depth < 1; depth += 0.002F) {
            float sum = 0;
            for (int group = 0; group < gn_convolution_groups(params.terms); ++group) {
                const vec4 stored = gn_convolution_encode(depth, group, params.span);
                sum += gn_convolution_group(stored, gn_convolution_receiver(0.45F, params), group, params);
            }
            most = std::max(most, sum - 0.5F);
        }
        return most;
    };
    EXPECT_GT(overshoot(0), 0.05F);
    EXPECT_LT(overshoot(1), 0.5F * overshoot(0));
    EXPECT_LT(overshoot(2), overshoot(1));
}

TEST(Convolution, ErrorFallsWithEveryDoublingOfTheTerms) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> uniform(0, 1);
    double previous = 1;
    for (const int terms : term_counts) {
        const GnConvolutionParams params{.terms = terms, .attenuation = 0, .offset = 0, .scale = 1};
        double sum = 0;
        random.seed(6);
        for (int i = 0; i < 2000; ++i) {
            std::vector<float> depths(9);
            float lit = 0;
            const float receiver = uniform(random);
            for (float& depth : depths) {
                depth = uniform(random);
                lit += receiver <= depth ? 1.0F / 9 : 0;
            }
            const double error = visible(depths, receiver, params) - lit;
            sum += error * error / 2000;
        }
        EXPECT_LT(std::sqrt(sum), 0.85 * previous) << terms << " terms";
        previous = std::sqrt(sum);
    }
}

TEST(Convolution, FarEndDoesNotWrapIntoLight) {
    // A caster at the near plane and a receiver at the far one are a half period apart where depth takes all of it.
    GnConvolutionParams params{.offset = 0, .scale = 1, .span = 1};
    EXPECT_GT(visible({0.0F}, 1.0F, params), 0.4F);
    params.span = GnConvolutionParams{}.span;
    EXPECT_LT(visible({0.0F}, 1.0F, params), 0.05F);
}

TEST(ConvolutionRendered, TendsToPercentageCloserFilteringWithMoreTerms) {
    // A bilinear fetch of a map blurred by 5 x 5 texels is the box of side 5; the deep courtyard needs every term. The
    // bare series is asked, neither moved nor scaled: one half on lit surfaces, and the shadows darken with every term.
    for (const std::string placement : {",placement=fit", ",placement=cascades"}) {
        const std::string rest = ",resolution=512" + placement;
        const auto pcf = test::compare("courtyard", "pcf,pcf.size=5" + rest, {.samples = 1});
        double previous = 1;
        for (const int terms : term_counts) {
            const auto c =
                test::compare("courtyard",
                              fmt::format("convolution,filtered.footprint=radius,filtered.radius=0,convolution.scale=1,"
                                          "convolution.offset=0,convolution.attenuation=0,convolution.terms={}",
                                          terms) +
                                  rest,
                              {.samples = 1});
            const Errors errors =
                visibility_errors(c.visibility().values, pcf.visibility().values, c.truth.counted, 192, 192);
            EXPECT_LT(*errors.rmse, previous) << terms << " terms" << placement;
            previous = *errors.rmse;
        }
    }
}

TEST(ConvolutionRendered, DefaultsFollowTheTermsFromTheSecondOn) {
    // One term alone is damped to 0.6 of itself and lights nothing whole: what it loses in light it gains in shadow, and
    // the sum of both errors says nothing of the series. From two terms on every doubling helps.
    double previous = 1;
    const auto pcf = test::compare("courtyard", "pcf,pcf.size=5,resolution=512", {.samples = 1});
    for (const int terms : {2, 4, 8, 16}) {
        const auto c = test::compare("courtyard",
                                     fmt::format("convolution,filtered.footprint=radius,filtered.radius=0,"
                                                 "resolution=512,convolution.terms={}",
                                                 terms),
                                     {.samples = 1});
        const Errors errors =
            visibility_errors(c.visibility().values, pcf.visibility().values, c.truth.counted, 192, 192);
        EXPECT_LT(*errors.rmse, previous) << terms << " terms";
        previous = *errors.rmse;
    }
}

TEST(ConvolutionRendered, AScaleOfTwoLeavesALitPlaneWithoutShadow) {
    // Nothing is moved: what lies on the receiver's own plane is one half, twice that is one. Over the kernel the plane
    // rises as much as it falls, and the series is odd about the step, so that the mean stays one half: what is left is
    // the rounding of 8 bits, half a unit of 255 a term by weights that sum to 2 / pi (1 + 1/3 + ...) = 1.3.
    const auto c =
        test::compare("tilted:angle=45", "convolution,resolution=512,convolution.scale=2,convolution.offset=0",
                      {.width = 96, .height = 96, .samples = 1});
    EXPECT_LE(*c.errors.acne, 2 * 1.3 * 0.5 / 255);
}

TEST(ConvolutionRendered, StaysInRangeAndFreeOfAcne) {
    for (const char* options : {"", ",convolution.terms=5", ",convolution.blur=gaussian,convolution.radius=5"}) {
        const auto c = test::compare("tilted:angle=75", std::string("convolution,resolution=512") + options,
                                     {.width = 96, .height = 96, .samples = 1});
        // As above: the rounding of 8 bits.
        EXPECT_LE(*c.errors.acne, 2 * 1.3 * 0.5 / 255) << options;
        for (const float v : c.visibility().values) {
            ASSERT_TRUE(v >= 0 && v <= 1) << v << options;
        }
    }
}

}  // namespace
}  // namespace gn::convolution_test
