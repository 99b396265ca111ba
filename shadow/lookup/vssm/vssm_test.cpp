// SPDX-License-Identifier: MIT
// The penumbra of a half-plane is as wide as the light makes it, whatever the map's resolution and the kind of light, though the
// map is only asked for a few boxes.
#include "shadow/lookup/vssm/vssm.glsl"

#include "tests/penumbra.h"

#include <cmath>

namespace gn::vssm_test {
namespace {

using namespace gn::glsl;

TEST(Vssm, PartsSpreadAsFarAsTheLight) {
    // Second moments along both axes of the map: of the middles and of a box around each, against those of the light, which are
    // a third of half a rectangle's side, squared, and a quarter of a disc's radius, squared.
    const vec2 right(3, 1), up(-0.5F, 2);
    for (const bool square : {false, true}) {
        for (const int side : {1, 2, 3, 8}) {
            const float share = gn_vssm_share(square);
            const vec2 box = gn_vssm_box(share * right, share * up) / static_cast<float>(side);
            vec2 spread = box * box / 3.0F;
            for (int i = 0; i < side * side; ++i) {
                const vec2 q = share * gn_vssm_part(i, side);
                const vec2 middle = q.x * right + q.y * up;
                spread += middle * middle / static_cast<float>(side * side);
            }
            const vec2 expected = (right * right + up * up) * (square ? 1.0F / 3 : 0.25F);
            EXPECT_NEAR(spread.x, expected.x, 1e-5) << side;
            EXPECT_NEAR(spread.y, expected.y, 1e-5) << side;
        }
    }
}

/// `mips`: what boxes that are fetched from mips are wrong by besides.
void expect_ramp(const char* scene, const std::string& recipe, int resolution, double mips = 0) {
    const auto c = test::compare(scene, fmt::format("{},resolution={}", recipe, resolution),
                                 {.width = 64, .height = 48, .samples = 64});
    const std::vector<test::Slice> slices = test::error_slices(c, 10);
    // A disc's ramp and that of the square that stands for it differ by at most 0.029, at the square's side. The map
    // decides a caster's edge to its texel, as seen on the receiver 2 m behind it: views are at most 24 m wide there,
    // ramps at least 0.5 m; boxes blend texels, so that it is half of one.
    const double shape = 0.029, texel = 24.0 / resolution / 2 / 0.5 / 2;
    for (std::size_t s = 0; s < slices.size(); ++s) {
        if (slices.at(s).samples > 20) {
            EXPECT_NEAR(slices.at(s).mean(), 0, shape + texel + mips)
                << scene << " by " << recipe << " at " << resolution << ", slice " << s;
        }
    }
}

TEST(VssmRendered, AHalfPlanesRampIsAsWideAsTheLightMakesIt) {
    for (const char* scene :
         {"half-plane", "half-plane:light=spot", "half-plane:light=point", "half-plane:light=directional"}) {
        for (const int resolution : {256, 1024}) {
            expect_ramp(scene, "vssm", resolution);
        }
        // Squares overlap within a box whose side is no power of two: a third of the kernel's is bent by at most an eighth.
        expect_ramp(scene, "vssm,map=vsm,vsm.squares=true,vsm.blur=none,vsm.bleeding=0", 256);
    }
}

/// Whatever map filters it, if nothing is cut off it and it is not blurred besides: a trilinear fetch of a third of the kernel's
/// width is a tent that reaches as far to both sides, whose mean way beyond an end is a sixth of it, a 1/18 of the ramp.
TEST(VssmRendered, AHalfPlanesRampIsAsWideOverMipsOfMoments) {
    for (const char* scene :
         {"half-plane", "half-plane:light=spot", "half-plane:light=point", "half-plane:light=directional"}) {
        expect_ramp(scene, "vssm,map=evsm,evsm.blur=none,evsm.bleeding=0", 512, 1.0 / 18);
        expect_ramp(scene, "vssm,map=msm,msm.blur=none,msm.bleeding=0", 512, 1.0 / 18);
    }
}

TEST(Vssm, TheSearchedRectangleHoldsAllParts) {
    // Of a disc as the light's points reach, of a rectangle as both of its axes do; then the kernel's parts.
    for (const bool square : {false, true}) {
        for (const int side : {1, 2, 3, 8}) {
            float most = 0;
            for (int turn = 0; turn < 64; ++turn) {
                const float a = 0.1F * static_cast<float>(turn);
                const vec2 right(std::cos(a), std::sin(a)), up(-right.y, 0.7F * right.x);
                GnVssmKernel kernel;
                kernel.right_ts = gn_vssm_share(square) * right;
                kernel.up_ts = gn_vssm_share(square) * up;
                kernel.box_ts = gn_vssm_box(kernel.right_ts, kernel.up_ts) / static_cast<float>(side);
                const vec2 reach = square ? abs(right) + abs(up) : gn_vssm_box(right, up);
                const vec2 parts = gn_vssm_around(kernel, side) / reach;
                most = std::max({most, parts.x, parts.y});
                for (int i = 0; i < side * side; ++i) {
                    const vec2 q = gn_vssm_part(i, side);
                    const vec2 end = abs(q.x * kernel.right_ts + q.y * kernel.up_ts) + kernel.box_ts;
                    EXPECT_LE(end.x, gn_vssm_around(kernel, side).x + 1e-6F);
                    EXPECT_LE(end.y, gn_vssm_around(kernel, side).y + 1e-6F);
                }
            }
            EXPECT_LE(most, gn_vssm_overhang(square, side) + 1e-6F) << square << ", " << side;
        }
    }
}

/// Whatever the extremes of a region decide, the parts of a kernel within it say: V does not jump where a map's texels fall
/// otherwise into the squares of its pyramid. Under moments that bleed, of boxes and of mips, which reach beyond them.
TEST(VssmRendered, EarlyOutsSkipWorkAndChangeNothing) {
    for (const auto& [scene, recipe] : {std::pair{"overlap", "vssm"},
                                        {"half-plane:light=spot", "vssm,map=evsm"},
                                        {"slab:light=directional", "vssm"},
                                        {"contact:radius=0.5", "vssm,vssm.side=1,vssm.least=0"}}) {
        const std::string both = fmt::format("{},resolution=256", recipe);
        const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 1};
        const auto with = test::compare(scene, both, size);
        const auto without = test::compare(scene, both + ",vssm.early_out=false", size);
        int differ = 0, decided = 0;
        float most = 0;
        for (std::size_t i = 0; i < with.visibility().values.size(); ++i) {
            const float v = with.visibility().values[i];
            const float apart = std::abs(v - without.visibility().values[i]);
            decided += v == 0 || v == 1 ? 1 : 0;
            differ += apart > 1e-6F ? 1 : 0;
            most = std::max(most, apart);
        }
        EXPECT_EQ(differ, 0) << scene << " by " << recipe << ", by " << most << " at most";
        EXPECT_GT(decided, 1000) << scene << " by " << recipe;
    }
}

/// Every part of a kernel meets the plane where it is, so that a slope is no blocker of its own.
TEST(VssmRendered, ASlopeDoesNotShadeItself) {
    const auto c = test::compare("tilted:angle=75", "vssm,resolution=256", {.width = 64, .height = 48, .samples = 1});
    EXPECT_LE(*c.errors.acne, 1e-4);
}

}  // namespace
}  // namespace gn::vssm_test
