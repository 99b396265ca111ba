// SPDX-License-Identifier: MIT
// What the theory of the filterable maps says of every sample: with the same kernel and receiver, Chebyshev's bound, its
// warped kin, the bound of four moments and the mean of exponentials are never darker than percentage-closer filtering.
//
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
#include "tests/rig.h"

#include <map>

namespace gn::bounds_test {
namespace {

/// The kernel is a box of five texels, read bilinearly, and the receiver one depth under the whole kernel.
constexpr const char* receiver = ",resolution=512,bias.receiver_plane=0,bias.cone=0,placement=";
/// Exponentials apply biases after the warp, where they are worth less: with none the receiver is the same to all.
constexpr const char* no_bias = ",bias.constant=0,bias.normal=0";
constexpr const char* fetch = ",filtered.footprint=radius,filtered.radius=0";

/// Rounding of the moments; 5e-6 at most was measured, with four moments. A GPU rounds the fractions of a fetch to 1/256, and
/// so moves a fifth of the kernel's weight by half of that on each axis; percentage-closer filtering weighs its own taps.
float rounding() {
    return 2e-5F + (test::device().info().cpu ? 0.0F : 2.0F * (1.0F / 512.0F) / 5.0F);
}

/// Every map without what bends its bound: no tail cut, no slope, no least deviation.
std::map<std::string, std::string> bounds() {
    const auto bare = [](const std::string& id) {
        return fmt::format(",{0}.bleeding=0,{0}.min_deviation=0,{0}.slope_moment=0", id);
    };
    return {{"vsm", "vsm" + bare("vsm")},
            {"lvsm", "lvsm,lvsm.format=float32,lvsm.splits=uniform" + bare("lvsm")},
            {"evsm2", "evsm2" + bare("evsm")},
            {"evsm4", "evsm4" + bare("evsm")},
            {"esm", "esm,esm.fallback=0"},
            {"msm", "msm,msm.format=float32,msm.moment_bias=1e-5,msm.ramp=0,msm.bleeding=0"}};
}

struct Exceedance {
    std::size_t samples = 0, beyond = 0;
    float worst = 0;
};

/// How often and how far `low` exceeds `high` by more than the slack.
Exceedance exceedance(const test::Comparison& low, const test::Comparison& high, float slack) {
    Exceedance result;
    for (std::size_t i = 0; i < low.truth.counted.size(); ++i) {
        if (low.truth.counted[i] != 0) {
            const float difference = low.visibility().values[i] - high.visibility().values[i];
            ++result.samples;
            result.beyond += difference > slack ? 1U : 0U;
            result.worst = std::max(result.worst, difference);
        }
    }
    return result;
}

TEST(BoundsRendered, NoMapIsDarkerThanPercentageCloserFilteringAtAnySample) {
    const test::ComparisonOptions once{.samples = 1};
    const std::pair<std::string, std::string> placed[] = {
        {"courtyard", "cascades"}, {"stack", "fit"}, {"fence", "fit"}};
    for (const auto& [scene, placement] : placed) {
        const std::string rest = receiver + placement;
        const auto pcf = test::compare(scene, "pcf,pcf.size=5" + rest, once);
        const auto unbiased = test::compare(scene, "pcf,pcf.size=5" + rest + no_bias, once);
        for (const auto& [name, recipe] : bounds()) {
            const bool warped = name.starts_with('e');
            const auto map = test::compare(scene, recipe + fetch + rest + (warped ? no_bias : ""), once);
            const Exceedance e = exceedance(warped ? unbiased : pcf, map, rounding());
            EXPECT_GT(e.samples, 1000U);
            EXPECT_EQ(e.beyond, 0U) << name << " on " << scene << " in " << placement << ", worst " << e.worst;
        }
    }
}

TEST(BoundsRendered, FourMomentsAndFourComponentsBoundMoreTightlyAtAnySample) {
    // The smaller of two bounds is at most the first. Four moments admit no distribution that two forbid; what
    // msm.moment_bias mixes in, a deviation of a thousandth of the range, is worth up to 0.05 where depths hardly vary.
    const test::ComparisonOptions once{.samples = 1};
    for (const std::string scene : {"courtyard", "stack", "fence"}) {
        const auto render = [&](const std::string& name) {
            return test::compare(scene, bounds().at(name) + fetch + receiver + "fit", once);
        };
        const Exceedance components = exceedance(render("evsm4"), render("evsm2"), 1e-5F);
        EXPECT_EQ(components.beyond, 0U) << scene << ", worst " << components.worst;
        const Exceedance moments = exceedance(render("msm"), render("vsm"), 0.05F);
        EXPECT_EQ(moments.beyond, 0U) << scene << ", worst " << moments.worst;
    }
}

}  // namespace
}  // namespace gn::bounds_test
