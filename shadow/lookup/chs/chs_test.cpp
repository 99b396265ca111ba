// SPDX-License-Identifier: MIT
#include "shadow/lookup/chs/chs.glsl"

#include "tests/penumbra.h"

#include <cmath>

namespace gn::chs_test {
namespace {

using namespace gn::glsl;

TEST(Chs, TheFinestMipIsTakenInWhichTheGridSpansTheKernel) {
    for (const float width : {0.0F, 6.9F, 7.1F, 14.0F, 100.0F}) {
        const int level = gn_chs_level(width, 8, 10);
        // Wherever the kernel begins, it touches at most a texel more than it is wide.
        EXPECT_LE(width / static_cast<float>(1 << level) + 1, 8) << width;
        EXPECT_TRUE(level == 0 || width / static_cast<float>(1 << (level - 1)) + 1 > 8) << width;
    }
    EXPECT_EQ(gn_chs_level(1000, 8, 3), 3);
}

TEST(Chs, MipsOfTilesEndWhereTheirTexelsWouldCrossTheBorder) {
    GnProjected projected{};
    projected.texel_ts = 1.0F / 1024;
    projected.bounds_ts = vec4(0, 0, 1, 1);
    EXPECT_EQ(gn_chs_coarsest(projected, 11), 10);
    projected.bounds_ts = vec4(0.25F, 0, 0.375F, 1);
    EXPECT_EQ(gn_chs_coarsest(projected, 11), 7);
    projected.bounds_ts = vec4(3.0F / 1024, 0, 0.375F, 1);
    EXPECT_EQ(gn_chs_coarsest(projected, 11), 0);
}

TEST(Chs, ATexelIsDecidedOnlyWhereAllOfItIs) {
    EXPECT_EQ(gn_chs_decided(vec2(0.6F, 0.9F), 0.4F, 0.5F), 0);
    EXPECT_EQ(gn_chs_decided(vec2(0.1F, 0.3F), 0.4F, 0.5F), 1);
    EXPECT_EQ(gn_chs_decided(vec2(0.1F, 0.45F), 0.4F, 0.5F), -1);
    EXPECT_EQ(gn_chs_decided(vec2(0.45F, 0.9F), 0.4F, 0.5F), -1);
}

TEST(Chs, TexelsCoverTheKernelsArea) {
    // What the texels of a grid have of a kernel is its area, to a tenth of a texel along its rim.
    const vec2 right(3, 1), up(-1, 2.5F);
    const float determinant = right.x * up.y - right.y * up.x;
    const vec2 half_side = abs(gn_chs_within(right, up, determinant, vec2(0.5F, 0))) +
                           abs(gn_chs_within(right, up, determinant, vec2(0, 0.5F)));
    for (const bool square : {false, true}) {
        double area = 0;
        for (int y = -12; y <= 12; ++y) {
            for (int x = -12; x <= 12; ++x) {
                const vec2 q = gn_chs_within(right, up, determinant, vec2(x, y) + vec2(0.3F, -0.2F));
                area += static_cast<double>(gn_chs_covered(square, q, half_side));
            }
        }
        EXPECT_NEAR(area, (square ? 4.0 : 3.14159) * static_cast<double>(determinant), square ? 3.6 : 2.0) << square;
    }
}

TEST(ChsRendered, WidthsAreTheLightsWhateverTheResolution) {
    for (const char* scene :
         {"half-plane", "half-plane:light=spot", "half-plane:light=point", "half-plane:light=directional"}) {
        for (const int resolution : {256, 1024}) {
            const auto c =
                test::compare(scene, fmt::format("chs,resolution={}", resolution), {.width = 64, .height = 48});
            // A penumbra too wide by a share s is too dark by s / 8 in its lit half and too bright by as much in its dark one.
            // The rim of a kernel 8 texels wide is known to one of them, and the caster's edge to a texel of the map.
            const double texel = 24.0 / resolution / 2 / 0.5;
            const vec2 wrong = test::error_halves(c);
            EXPECT_NEAR(wrong.x, 0, 1.0 / 8 / 8 + texel) << scene << " at " << resolution;
            EXPECT_NEAR(wrong.y, 0, 1.0 / 8 / 8 + texel) << scene << " at " << resolution;
        }
    }
}

TEST(ChsRendered, TexelsThatAnEdgeCrossesAreLookedInto) {
    const test::ComparisonOptions size{.width = 64, .height = 48};
    const auto points = test::compare("slab", "chs", size);
    const auto means = test::compare("slab", "chs,chs.texels=mean", size);
    // Half a texel of 8 that an edge crosses and that hides the light whole is a 16th of the ramp.
    EXPECT_LT(*points.errors.rmse, 0.02);
    EXPECT_GT(*means.errors.rmse, *points.errors.rmse + 1.0 / 32);
}

}  // namespace
}  // namespace gn::chs_test
