// SPDX-License-Identifier: MIT
#include "shadow/map/esm/esm.glsl"

#include "scenes/analytic.h"
#include "shadow/map/prefilter.h"
#include "tests/rig.h"

#include <random>

namespace gn::esm_test {
namespace {

using namespace gn::glsl;

TEST(Esm, NoAcceptedExponentOverflows) {
    // Four samples are added before they are divided.
    const auto greatest = static_cast<float>(find_part(Stage::map, "esm").params.find("exponent")->max);
    EXPECT_TRUE(std::isfinite(4 * gn_esm_encode(1, greatest)));
    EXPECT_GT(gn_esm_product(gn_esm_encode(1, greatest), 1, greatest), 0.99F);
}

TEST(Esm, TendsToThePercentageWhereNothingLiesBeyondTheReceiver) {
    // Casters at least `gap` before the receiver add at most exp(-c gap): [EASW09] eq. 4.7.
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 500; ++i) {
        const float receiver = 0.5F + 0.5F * uniform(random);
        const float gap = 0.1F;
        float mean = 0;
        float lit = 0;
        for (int k = 0; k < 16; ++k) {
            const bool open = uniform(random) < 0.5F;
            mean += gn_esm_encode(open ? receiver : (receiver - gap) * uniform(random), 80) / 16;
            lit += open ? 1.0F / 16 : 0;
        }
        const float product = gn_esm_product(mean, receiver, 80);
        EXPECT_GE(product, lit - 1e-4);
        EXPECT_LE(product, lit + std::exp(-80 * gap) + 1e-4);
        EXPECT_FALSE(gn_esm_fails(product, 1e-3F));
    }
}

TEST(Esm, NoticesDepthsFarBeyondTheReceiver) {
    // A tenth of the kernel sees 0.1 deeper: exp(8) / 10 is far above one, though 9 of 10 texels may shadow.
    const float mean = 0.9F * gn_esm_encode(0.3F, 80) + 0.1F * gn_esm_encode(0.6F, 80);
    EXPECT_TRUE(gn_esm_fails(gn_esm_product(mean, 0.5F, 80), 0.02F));
}

TEST(Esm, CellsOfTheFallbackCoverItsBoxOnce) {
    for (const float start : {0.0F, 0.3F, 7.9F}) {
        for (const float step : {1.0F, 2.0F}) {
            float sum = 0;
            for (float cell = std::floor(start / step) * step; cell < start + 5; cell += step) {
                sum += gn_esm_weight(cell, step, start, 5, 1, GN_BLUR_BOX);
            }
            EXPECT_NEAR(sum, 5, 1e-5);
        }
    }
}

TEST(Esm, TheFallbackWeighsTexelsAsABilinearFetchOfTheBlurredMapDoes) {
    // A fetch at `at` mixes the blurs around its two nearest texels.
    constexpr int reach = 4;
    for (const int blur : {GN_BLUR_BOX, GN_BLUR_GAUSSIAN}) {
        const std::vector<float> weights = blur_weights(blur, reach);
        const auto blurred = [&](int distance) {
            return std::abs(distance) <= reach ? weights[static_cast<std::size_t>(std::abs(distance))] : 0.0F;
        };
        for (const float at : {20.5F, 20.7F, 21.0F, 21.25F}) {
            const int left = static_cast<int>(std::floor(at - 0.5F));
            const float share = at - 0.5F - static_cast<float>(left);
            const float size = 2 * reach + 1;
            float total = 0;
            for (int texel = 10; texel < 32; ++texel) {
                total += gn_esm_weight(static_cast<float>(texel), 1, at - 0.5F * size, size, 1, blur);
            }
            for (int texel = 10; texel < 32; ++texel) {
                const float weight = gn_esm_weight(static_cast<float>(texel), 1, at - 0.5F * size, size, 1, blur);
                const float expected = (1 - share) * blurred(texel - left) + share * blurred(texel - left - 1);
                EXPECT_NEAR(weight / total, expected, 1e-5F) << "blur " << blur << " at " << at << " texel " << texel;
            }
        }
    }
}

TEST(Esm, ABiasIsAShareOfTheProduct) {
    GnProjected projected{};
    projected.depth = 0.49F;
    projected.bias = 0.01F;
    const float mean = gn_esm_encode(0.5F, 80);
    EXPECT_NEAR(gn_esm_product(mean, gn_esm_receiver(projected, 80), 80), std::exp(0.01F), 1e-4F);
}

TEST(Esm, ACellOfMixedDepthsIsLitByTheShareBehindTheReceiver) {
    EXPECT_EQ(gn_esm_between(vec2(0.4F, 0.6F), 0.4F), 1.0F);
    EXPECT_NEAR(gn_esm_between(vec2(0.4F, 0.6F), 0.45F), 0.75F, 1e-5F);
    EXPECT_EQ(gn_esm_between(vec2(0.4F, 0.6F), 0.61F), 0.0F);
    EXPECT_EQ(gn_esm_between(vec2(0.5F, 0.5F), 0.5F), 1.0F);
}

TEST(EsmRendered, FallbackIsCloserToPercentageCloserFilteringThanWithout) {
    // The stack's edges hold depths beyond A and B under the kernel.
    const std::string map = ",resolution=512,esm.radius=4";
    const auto pcf = test::compare("stack", "pcf,resolution=512,pcf.size=9");
    const auto rmse_to_pcf = [&](const std::string& options) {
        const auto c = test::compare("stack", "esm" + map + options);
        return *visibility_errors(c.visibility().values, pcf.visibility().values, c.truth.counted, 192, 192).rmse;
    };
    const double with = rmse_to_pcf("");
    const double without = rmse_to_pcf(",esm.fallback=false");
    EXPECT_LT(with, 0.9 * without);
}

/// rmse of one recipe's visibility to another's.
double rmse_between(const std::string& scene, const std::string& recipe, const std::string& other) {
    const auto a = test::compare(scene, recipe, {.samples = 1});
    const auto b = test::compare(scene, other, {.samples = 1});
    return *visibility_errors(a.visibility().values, b.visibility().values, a.truth.counted, 192, 192).rmse;
}

TEST(EsmRendered, ByTheGreatestDepthTheFallbackIsPercentageCloserFiltering) {
    // Where any texel under the kernel lies beyond the receiver all are compared, whatever the size of the kernel; where
    // none does, a gap h lets exp(-c h) through and nothing else differs.
    const std::string rest = ",resolution=512,placement=fit,filtered.footprint=radius,filtered.radius=0";
    for (const int radius : {2, 15}) {
        const double rmse = rmse_between(
            "stack",
            fmt::format("esm,esm.classifier=maximum,esm.epsilon=0,esm.exponent=85,esm.radius={}", radius) + rest,
            fmt::format("pcf,resolution=512,placement=fit,pcf.size={}", 2 * radius + 1));
        EXPECT_LT(rmse, 5e-3) << radius;
    }
}

TEST(EsmRendered, TheFallbackComparesEverySampleOfATexel) {
    // Four samples, no blur: along straight edges the mean of a texel's four comparisons is nearer to the half texels of a
    // map of twice the side than one comparison with what the mean of their exponentials stands for.
    const std::string esm =
        "esm,esm.classifier=maximum,esm.epsilon=0,esm.blur=none,esm.mipmaps=false,resolution=256,"
        "placement=fit,filtered.footprint=radius,filtered.radius=0,esm.samples=";
    const std::string fine = "pcf,pcf.size=2,resolution=512,placement=fit";
    EXPECT_LT(rmse_between("stack", esm + "4", fine), 0.8 * rmse_between("stack", esm + "1", fine));
}

TEST(EsmRendered, StaysInRangeAndFreeOfAcne) {
    for (const char* options : {"", ",esm.samples=4", ",esm.blur=none", ",esm.exponent=85,esm.blur=gaussian"}) {
        const auto c = test::compare("tilted:angle=75", std::string("esm,resolution=512") + options,
                                     {.width = 96, .height = 96, .samples = 1});
        // The mean of exponentials over a plane is no less than the exponential of their mean, so that nothing darkens but
        // what rounds: 85 times the 2^-24 of a depth.
        EXPECT_LE(*c.errors.acne, 1e-4) << options;
        for (const float v : c.visibility().values) {
            ASSERT_TRUE(v >= 0 && v <= 1) << v << options;
        }
    }
}

}  // namespace
}  // namespace gn::esm_test
