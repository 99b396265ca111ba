// SPDX-License-Identifier: MIT
// The series of blockers' depths tends to their mean, and a half-plane's penumbra is as wide as the light makes it.
#include "shadow/map/cssm/cssm.glsl"

#include "tests/penumbra.h"

#include <cmath>

namespace gn::cssm_test {
namespace {

using namespace gn::glsl;

constexpr float span = 0.9F;

/// What a kernel tells of its blockers that holds the depth d_o over a share of it, and the receiver's own over the rest. The step
/// is moved by `offset` of the range, whatever its width.
vec2 found_of_two(float d_o, float d_r, float share, int terms, float offset) {
    GnCssmParams params;
    params.terms = terms;
    params.attenuation = 0;
    params.span = span;
    const GnConvolutionParams series = gn_cssm_series(params, offset * span * 2 * static_cast<float>(terms));
    const float receiver = gn_convolution_receiver(d_r, series);
    const int groups = gn_convolution_groups(terms);
    const auto mean = [&](auto encode) { return share * encode(d_o) + (1 - share) * encode(d_r); };
    float waves = 0;
    float depth_waves = 0;
    for (int g = 0; g < groups; ++g) {
        waves +=
            gn_convolution_group(mean([&](float z) { return gn_convolution_encode(z, g, span); }), receiver, g, series);
        depth_waves +=
            gn_convolution_group(mean([&](float z) { return gn_cssm_encode(z, g, terms, span); }), receiver, g, series);
    }
    const vec4 last = mean([&](float z) { return gn_cssm_encode(z, groups, terms, span); });
    return gn_cssm_found(waves, depth_waves, last.x, span);
}

TEST(Cssm, TheMeanDepthOfBlockersTendsToTheirs) {
    // Half of the kernel hides the light from 0.3, and with a fixed offset the rest is lit. What is left beside a truncated
    // step is a wave 1 / (2 pi M sin(pi x)) high, at the way x to it in halves of the period; the nearer is the offset's.
    for (const int terms : {4, 16, 64, 256, 1024}) {
        const vec2 found = found_of_two(0.3F, 0.6F, 0.5F, terms, 0.1F);
        const double wave = 1 / (2 * 3.14159 * terms * std::sin(3.14159 * 0.1 * static_cast<double>(span)));
        EXPECT_NEAR(found.x, 0.5, wave) << terms;
        // Of the half that is lit so much counts, at 0.6, against the half that hides.
        EXPECT_NEAR(found.y, 0.3, (0.6 - 0.3) * wave / (1 - 2 * wave)) << terms;
    }
    EXPECT_NEAR(found_of_two(0.3F, 0.6F, 0.5F, 1024, 0.1F).y, 0.3, 2e-4);
}

TEST(Cssm, WithoutAnOffsetHalfOfTheReceiverIsAmongItsBlockers) {
    // The step is one half where it stands: (d_o + d_r / 2) / (1 + 1 / 2).
    EXPECT_NEAR(found_of_two(0.3F, 0.6F, 0.5F, 1024, 0).y, (2 * 0.3 + 0.6) / 3, 1e-3);
}

TEST(Cssm, DepthsFillTheirFormat) {
    for (int i = 0; i <= 100; ++i) {
        for (int g = 0; g < gn_cssm_groups(16); ++g) {
            const vec4 stored = gn_cssm_encode(static_cast<float>(i) / 100, g, 16, 1);
            for (int k = 0; k < 4; ++k) {
                EXPECT_TRUE(stored[k] >= 0 && stored[k] <= 1) << stored[k] << " of group " << g;
            }
        }
    }
}

TEST(CssmRendered, AHalfPlanesRampIsAsWideAsTheLightMakesIt) {
    for (const char* scene :
         {"half-plane", "half-plane:light=spot", "half-plane:light=point", "half-plane:light=directional"}) {
        for (const int resolution : {256, 512}) {
            const auto c = test::compare(scene, fmt::format("cssm,resolution={}", resolution),
                                         {.width = 64, .height = 48, .samples = 64});
            // A penumbra too wide by a share s is too bright by s / 8 in its dark half and too dark by as much in its lit one.
            // Mips are boxes that a tent blends, three times a box's second moment: 4 x 4 of them spread by the root of
            // 1 + 2 / 16. A truncated step overshoots by up to 0.09 of what is lit, a quarter of the kernel in the dark
            // half on the mean, and leaves up to 0.05 of what is not. A disc and its square differ by 0.005 on the mean.
            const double width = (std::sqrt(1 + 2.0 / 16) - 1) / 8, over = 0.09, under = 0.05, shape = 0.005;
            const vec2 wrong = test::error_halves(c);
            EXPECT_NEAR(wrong.x, 0, width + shape + 0.25 * over + 0.75 * under) << scene << " at " << resolution;
            EXPECT_NEAR(wrong.y, 0, width + shape + 0.75 * over + 0.25 * under) << scene << " at " << resolution;
        }
    }
}

}  // namespace
}  // namespace gn::cssm_test
