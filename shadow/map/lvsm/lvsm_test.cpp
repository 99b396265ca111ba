// SPDX-License-Identifier: MIT
#include "shadow/map/lvsm/lvsm.glsl"

#include "scenes/analytic.h"
#include "tests/rig.h"

#include <array>
#include <random>

namespace {
std::array<vec3, 1025> prefix;
}
#define GN_LLOYD_BEFORE(i) prefix[static_cast<std::size_t>(i)]
#include "shadow/map/lvsm/lloyd.glsl"

namespace gn::lvsm_test {
namespace {

using namespace gn::glsl;

void set_histogram(const std::vector<std::pair<float, float>>& weighted_depths) {
    std::array<double, GN_LVSM_BINS> bins{};
    for (const auto& [depth, weight] : weighted_depths) {
        bins.at(static_cast<std::size_t>(depth * GN_LVSM_BINS)) += weight;
    }
    dvec3 sum(0);
    for (std::size_t i = 0; i < bins.size(); ++i) {
        prefix[i] = vec3(sum);
        const double x = (static_cast<double>(i) + 0.5) / GN_LVSM_BINS - 0.5;
        sum += bins[i] * dvec3(1, x, x * x);
    }
    prefix[GN_LVSM_BINS] = vec3(sum);
}

GnLloydSplits relax(int layers, int iterations) {
    GnLloydSplits splits = gn_lloyd_uniform(layers);
    for (int i = 0; i < iterations; ++i) {
        splits = gn_lloyd_iterate(splits, layers);
    }
    return splits;
}

TEST(Lvsm, AnIntervalIsStretchedOverTheWholeRange) {
    const vec2 interval(0.2F, 0.6F);
    EXPECT_EQ(gn_lvsm_warp(0.2F, interval), 0.0F);
    EXPECT_NEAR(gn_lvsm_warp(0.3F, interval), 0.25F, 1e-6);
    EXPECT_NEAR(gn_lvsm_warp(0.6F, interval), 1.0F, 1e-6);
    EXPECT_EQ(gn_lvsm_warp(0.1F, interval), 0.0F);
    EXPECT_EQ(gn_lvsm_warp(0.9F, interval), 1.0F);
}

TEST(Lvsm, LayersReachOverTheirSplitsAndRelaxedOnesLieBehindTheirSurface) {
    const GnLvsmParams params{.layers = 3, .overlap = 0.06F};
    EXPECT_EQ(gn_lvsm_interval(0, 0, 0.3F, params), vec2(0, 0.3F + 0.02F));
    EXPECT_EQ(gn_lvsm_interval(1, 0.3F, 0.6F, params), vec2(0.3F - 0.02F, 0.6F + 0.02F));
    EXPECT_EQ(gn_lvsm_interval(2, 0.6F, 1, params), vec2(0.6F - 0.02F, 1));
    EXPECT_EQ(gn_lvsm_behind(0.5F, 1, params), 0.5F + 0.02F);
    EXPECT_EQ(gn_lvsm_behind(0.0F, 0, params), 0.0F);
    EXPECT_EQ(gn_lvsm_behind(1.0F, 3, params), 1.0F);
}

TEST(Lvsm, OneLayerIsAVarianceMap) {
    const GnLvsmParams params{.layers = 1, .format = GN_LVSM_FLOAT32, .bleeding = 0};
    const vec2 interval = gn_lvsm_interval(0, 0, 1, params);
    EXPECT_EQ(interval, vec2(0, 1));
    for (float depth = 0; depth <= 1; depth += 0.0625F) {
        const float spread = gn_vsm_spread(0.125F, 0);
        EXPECT_EQ(gn_lvsm_moments(depth, spread, interval), gn_vsm_moments(depth, spread));
        EXPECT_EQ(gn_lvsm_bound(vec2(0.4F, 0.2F), depth, interval, 0.01F, params),
                  gn_vsm_chebyshev(vec2(0.4F, 0.2F), depth, 0.01F * 0.01F));
    }
}

TEST(Lvsm, BoundIsNeverBelowPercentageCloserFilteringInTheReceiversLayer) {
    // A monotonic warp keeps who is nearer, so that Chebyshev's bound holds; occluders above the layer make it exact.
    const GnLvsmParams params{.layers = 4, .overlap = 0, .format = GN_LVSM_FLOAT32, .bleeding = 0};
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 500; ++i) {
        const float receiver = uniform(random);
        const int layer = static_cast<int>(receiver * 4);
        const vec2 interval =
            gn_lvsm_interval(layer, static_cast<float>(layer) / 4, static_cast<float>(layer + 1) / 4, params);
        vec2 mean(0);
        float lit = 0;
        bool above = true;
        for (int k = 0; k < 9; ++k) {
            const float depth = i % 2 == 0 ? uniform(random) : (k % 3 == 0 ? receiver : uniform(random) * interval.x);
            mean += gn_lvsm_moments(depth, 0, interval) / 9.0F;
            lit += receiver <= depth ? 1.0F / 9 : 0;
            above = above && (depth <= interval.x || depth == receiver);
        }
        const float bound = gn_lvsm_bound(mean, receiver, interval, 0, params);
        EXPECT_GE(bound, lit - 1e-3);
        if (above && receiver - interval.x > 0.02F) {
            EXPECT_NEAR(bound, lit, 2e-3) << receiver;
        }
    }
}

TEST(Lvsm, SecondOccluderOfAnEdgeIsTheFartherDepth) {
    // [Lau08] 4.1.2: half the samples at a, half at b: mu + sigma = max(a, b).
    const vec2 sample = gn_lloyd_sample(vec4(0.25F, 0.75F, 0.75F, 0.25F));
    EXPECT_NEAR(sample.x, 0.75, 1e-6);
    EXPECT_NEAR(sample.y, 0.0625, 1e-6);
    EXPECT_EQ(gn_lloyd_sample(vec4(0.5F)).y, 0);
}

TEST(Lvsm, RelaxationFindsThePeaks) {
    set_histogram({{0.11F, 1}, {0.13F, 1}, {0.52F, 3}, {0.9F, 2}});
    const GnLloydSplits splits = relax(4, 8);
    EXPECT_NEAR(splits.at[1], 0.12, 2e-3);
    EXPECT_NEAR(splits.at[2], 0.52, 2e-3);
    EXPECT_NEAR(splits.at[3], 0.9, 2e-3);
    EXPECT_EQ(splits.at[0], 0);
    EXPECT_EQ(splits.at[4], 1);
}

TEST(Lvsm, EmptySplitTeleportsIntoTheHeaviestCluster) {
    // All peaks lie in the reach of the first of three equal splits; the second and third start without a sample.
    set_histogram({{0.02F, 4}, {0.1F, 4}, {0.3F, 2}});
    const GnLloydSplits splits = relax(4, 8);
    EXPECT_NEAR(splits.at[1], 0.02, 2e-3);
    EXPECT_NEAR(splits.at[2], 0.1, 2e-3);
    EXPECT_NEAR(splits.at[3], 0.3, 2e-3);
    // Mirrored, the first and second start without one, and make room from the other side.
    set_histogram({{0.98F, 4}, {0.9F, 4}, {0.7F, 2}});
    const GnLloydSplits mirrored = relax(4, 8);
    EXPECT_NEAR(mirrored.at[1], 0.7, 2e-3);
    EXPECT_NEAR(mirrored.at[2], 0.9, 2e-3);
    EXPECT_NEAR(mirrored.at[3], 0.98, 2e-3);
}

TEST(Lvsm, TeleportedSplitsStandADeviationToEitherSideOfTheMeanInOrder) {
    // Mean 0.108 and deviation 0.1024 of the peaks of the test above; splits begin at 1/4, 1/2, 3/4.
    constexpr double bin = 1.0 / GN_LVSM_BINS;
    set_histogram({{0.02F, 4}, {0.1F, 4}, {0.3F, 2}});
    const GnLloydSplits splits = gn_lloyd_teleport(gn_lloyd_uniform(4), 4);
    EXPECT_NEAR(splits.at[1], 0.108 - 0.1024, bin);
    EXPECT_NEAR(splits.at[2], 0.108 + 0.1024, bin);
    EXPECT_EQ(splits.at[3], 0.75F);
    set_histogram({{0.98F, 4}, {0.9F, 4}, {0.7F, 2}});
    const GnLloydSplits mirrored = gn_lloyd_teleport(gn_lloyd_uniform(4), 4);
    EXPECT_EQ(mirrored.at[1], 0.5F);
    EXPECT_NEAR(mirrored.at[2], 0.892 - 0.1024, bin);
    EXPECT_NEAR(mirrored.at[3], 0.892 + 0.1024, bin);
}

TEST(Lvsm, RelaxationKeepsTheOrderAndNeverGrowsTheError) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 0.999F);
    for (int round = 0; round < 50; ++round) {
        std::vector<std::pair<float, float>> depths;
        for (int i = 0; i < 60; ++i) {
            const float depth = uniform(random);
            depths.emplace_back(round % 2 == 0 ? depth : depth * depth * depth * 0.2F, uniform(random));
        }
        set_histogram(depths);
        const auto error = [&](const GnLloydSplits& splits, int layers) {
            double sum = 0;
            for (const auto& [depth, weight] : depths) {
                double nearest = 1;
                for (int k = 1; k < layers; ++k) {
                    nearest = std::min(nearest, std::abs(static_cast<double>(depth) - splits.at[k]));
                }
                sum += weight * nearest * nearest;
            }
            return sum;
        };
        for (const int layers : {2, 5, 16}) {
            const GnLloydSplits end = relax(layers, 12);
            EXPECT_LE(error(end, layers), error(gn_lloyd_uniform(layers), layers) + 1e-3);
            for (int k = 0; k < layers; ++k) {
                EXPECT_LE(end.at[k], end.at[k + 1]) << layers << ", split " << k;
            }
        }
    }
}

TEST(Lvsm, WithoutDiscontinuitiesSplitsStayUniform) {
    set_histogram({});
    const GnLloydSplits splits = relax(8, 4);
    for (int k = 0; k <= 8; ++k) {
        EXPECT_EQ(splits.at[k], static_cast<float>(k) / 8);
    }
}

// What the tests on `stack` see: samples of C under the middle of B, far from B's own edge.
double worst_under_b(const test::Comparison& c) {
    double worst = 0;
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const vec4 p_ws = c.frame.samples.position_ws[i];
        if (p_ws.w > 0.5F && p_ws.y < 1e-3F && std::abs(p_ws.z) < 0.8F && std::abs(p_ws.x) < 0.8F &&
            c.truth.visibility[i] == 0) {
            worst = std::max(worst, static_cast<double>(c.visibility().values[i]));
        }
    }
    return worst;
}

// One view of the whole scene: a fitted one clamps A and B to its near plane, where nothing can bleed.
constexpr const char* plain =
    ".bleeding=0,{0}.min_deviation=0,{0}.blur=box,{0}.radius=6,{0}.mipmaps=false,placement=single,resolution=512";

std::string options(const std::string& part, const std::string& more) {
    return fmt::format("{0},{0}", part) + fmt::format(fmt::runtime(plain), part) + more;
}

TEST(LvsmRendered, OneLayerIsVsm) {
    const test::ComparisonOptions size{.width = 128, .height = 128, .samples = 16};
    for (const char* samples : {"1", "4"}) {
        const auto vsm = test::compare("stack", options("vsm", fmt::format(",vsm.samples={}", samples)), size);
        const auto lvsm = test::compare(
            "stack", options("lvsm", fmt::format(",lvsm.layers=1,lvsm.format=float32,lvsm.samples={}", samples)), size);
        const auto fixed =
            test::compare("stack", options("lvsm", fmt::format(",lvsm.layers=1,lvsm.samples={}", samples)), size);
        for (std::size_t i = 0; i < vsm.visibility().values.size(); ++i) {
            const float expected = vsm.visibility().values[i];
            ASSERT_NEAR(lvsm.visibility().values[i], expected, 1e-4) << i;
            // The least variance of 16 bits adds at most its share of the variance of an edge.
            ASSERT_GE(fixed.visibility().values[i], expected - 5e-3) << i;
            ASSERT_LE(fixed.visibility().values[i], expected + 0.05) << i;
        }
    }
}

TEST(LvsmRendered, ALayerBetweenBAndCStopsTheBleedingOfTheStack) {
    const test::ComparisonOptions under{.view = "under"};
    const double bled = worst_under_b(test::compare("stack", options("vsm", ""), under));
    EXPECT_GE(bled, scenes::stack_scene::bleeding(scenes::stack_scene::dy) - 2e-3);
    // With this many equal layers one boundary or more lies between B and C.
    for (const char* format : {"unorm16", "float32"}) {
        for (const char* placement : {"single", "cascades"}) {
            const std::string more = fmt::format(
                ",lvsm.splits=uniform,lvsm.layers=8,lvsm.overlap=0,lvsm.format={},placement={}", format, placement);
            EXPECT_LE(worst_under_b(test::compare("stack", options("lvsm", more), under)), 1e-3) << more;
        }
    }
}

TEST(LvsmRendered, EightBitsStopItWhereLayersAreThin) {
    // Half the bytes. The occluders lie flat on the front of C's layer, where rounding may be a variance of 1.5 / 255: what
    // it lets through to the back half of the layer, in which C lies here, is 0.0059 / (0.0059 + 1/4).
    const auto c = test::compare("stack", options("lvsm", ",lvsm.splits=uniform,lvsm.layers=16,lvsm.format=unorm8"),
                                 {.view = "under"});
    EXPECT_LE(worst_under_b(c), 0.023);
}

TEST(LvsmRendered, WeightsOfTheRelaxationCanBeClamped) {
    // No edge has a deviation of 1: none draws a split, and all stay equal. Where every edge weighs the same the splits go
    // elsewhere than where high ones weigh more.
    const auto uniform = test::compare("courtyard", "lvsm,resolution=256,lvsm.splits=uniform", {.samples = 1});
    const auto dropped = test::compare("courtyard", "lvsm,resolution=256,lvsm.weight_least=1", {.samples = 1});
    const auto relaxed = test::compare("courtyard", "lvsm,resolution=256", {.samples = 1});
    const auto capped = test::compare("courtyard", "lvsm,resolution=256,lvsm.weight_most=0.001", {.samples = 1});
    EXPECT_NE(relaxed.visibility().values, dropped.visibility().values);
    EXPECT_NE(relaxed.visibility().values, capped.visibility().values);
    EXPECT_NE(capped.visibility().values, dropped.visibility().values);
    // A relaxed split lies one overlap further behind.
    const Errors errors =
        visibility_errors(dropped.visibility().values, uniform.visibility().values, uniform.truth.counted, 192, 192);
    EXPECT_LT(*errors.rmse, 0.02);
}

TEST(LvsmRendered, RelaxedSplitsStopItToo) {
    // Splits are found behind B and behind C, whatever the overlap: C is lit in no layer that it is blended from.
    const test::ComparisonOptions under{.view = "under"};
    for (const char* more : {"", ",lvsm.layers=3", ",lvsm.overlap=0", ",lvsm.overlap=0.2"}) {
        const auto c = test::compare("stack", options("lvsm", more), under);
        EXPECT_LE(worst_under_b(c), 1e-3) << more;
    }
}

TEST(LvsmRendered, SplitsOnTheReceiverDoNotLightIt) {
    // Every edge that the light sees here ends on the floor, so that the relaxed splits lie in it.
    for (const char* more : {"", ",lvsm.layers=2", ",lvsm.format=float32", ",lvsm.transition=0"}) {
        const auto c = test::compare("overlap", std::string("lvsm,resolution=512") + more);
        EXPECT_LE(*c.errors.leak, 1e-3) << more;
    }
}

TEST(Lvsm, TransitionsBeginAtTheSplit) {
    // Before it the farther layer calls lit what lies flat on its front.
    EXPECT_EQ(gn_lvsm_transition(0, 0.1F), 0);
    EXPECT_EQ(gn_lvsm_transition(0.1F, 0.1F), 1);
    EXPECT_NEAR(gn_lvsm_transition(0.05F, 0.1F), 0.5, 1e-6);
    EXPECT_EQ(gn_lvsm_transition(0, 0), 1);
    // At the split the nearer layer answers alone, at the end of the transition the farther.
    EXPECT_EQ(gn_lvsm_between(0.2F, 0.8F, 0, 0.1F), 0.2F);
    EXPECT_EQ(gn_lvsm_between(0.2F, 0.8F, 0.1F, 0.1F), 0.8F);
}

TEST(LvsmRendered, StaysInRangeAndFreeOfAcneAtTheDefaults) {
    for (const char* more : {"", ",lvsm.samples=4", ",lvsm.layers=16,lvsm.overlap=0.5", ",lvsm.layers=3,lvsm.blur=none",
                             ",lvsm.splits=uniform,lvsm.layers=7,lvsm.transition=0"}) {
        const auto c = test::compare("tilted:angle=75", std::string("lvsm,resolution=512") + more,
                                     {.width = 96, .height = 96, .samples = 4});
        // Where a kernel lies half before its layer's front the mean comes nearer by 0.4 sigma and the variance falls to 0.34
        // of itself: 0.4 of the light is lost at such a split. Overlaps keep receivers from there by a twentieth of a layer,
        // twice the kernel and more; what is left is what 16 bits round.
        EXPECT_LE(*c.errors.acne, 1e-3) << more;
        for (const float v : c.visibility().values) {
            ASSERT_TRUE(v >= 0 && v <= 1) << v;
        }
    }
}

}  // namespace
}  // namespace gn::lvsm_test
