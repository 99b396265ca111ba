// SPDX-License-Identifier: MIT
// The truth against closed forms on geometry made here, and its promises: threads, alpha, no self-intersection.
#include "reference/truth.h"

#include "base/error.h"
#include "base/stats.h"
#include "reference/quads_test.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace gn::truth_test {
namespace {

/// size x size points of the square [-half, half]^2 of the plane y = 0.
Samples ground_samples(int size, float half) {
    Samples samples;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const vec2 p = (vec2(x, y) + 0.5F) / static_cast<float>(size) * 2.0F - 1.0F;
            samples.add({half * p.x, 0, half * p.y}, {0, 1, 0});
        }
    }
    return samples;
}

GnLight panel(float height, vec2 half_size) {
    GnLight light;
    light.kind = GN_LIGHT_RECTANGLE;
    light.position_ws = vec4(0, height, 0, 0);
    light.direction_ws = vec4(0, -1, 0, 0);
    light.half_size = half_size;
    return light;
}

/// Ground, and a rectangle of half extents `occluder` half-way to a panel of half extents `light` at 4 m.
struct Slab {
    QuadScene quads;
    GnLight light;
    vec2 occluder{0.5F, 0.4F};
    Slab() : light(panel(4, {0.4F, 0.3F})) {
        quads.add({-10, 0, -10}, {0, 0, 20}, {20, 0, 0});
        quads.add({-occluder.x, 2, -occluder.y}, {2 * occluder.x, 0, 0}, {0, 0, 2 * occluder.y});
    }
    /// The fraction of the interval of the light that the interval of the occluder covers, seen from coordinate x.
    static double covered(double x, double occluder, double light) {
        const double low = std::max(-light, x + 2 * (-occluder - x));
        const double high = std::min(light, x + 2 * (occluder - x));
        return std::max(0.0, high - low) / (2 * light);
    }
    [[nodiscard]] double visibility(vec3 p) const {
        return 1.0 - covered(p.x, occluder.x, light.half_size.x) * covered(p.z, occluder.y, light.half_size.y);
    }
};

struct Difference {
    double rmse = 0, explained = 0, mean = 0;  ///< explained: root mean square of the reported standard errors
};

Difference against(const Slab& slab, const Samples& samples, const TruthResult& result) {
    Difference d;
    const auto count = static_cast<double>(samples.position_ws.size());
    for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
        EXPECT_EQ(result.counted[i], 1);
        const double error = static_cast<double>(result.visibility[i]) - slab.visibility(vec3(samples.position_ws[i]));
        const auto se = static_cast<double>(result.standard_error[i]);
        d.rmse += error * error / count;
        d.explained += se * se / count;
        d.mean += error / count;
    }
    d.rmse = std::sqrt(d.rmse);
    d.explained = std::sqrt(d.explained);
    return d;
}

TEST(Truth, TracesExactlyThePointsThatAreGiven) {
    // Each receiver sees both of two points, one, or none, and nothing is estimated. The panel is wide, so that its shadows
    // overlap in part.
    const GnLight light = panel(4, {0.8F, 0.1F});
    const Slab slab;
    const Truth truth(slab.quads.scene);
    const Samples samples = ground_samples(24, 1.4F);
    const LightSamples both = light_samples(light, 2);
    const TruthResult result =
        truth.trace(samples.position_ws, samples.normal_ws, light, {.exactly = &both, .width = 24});
    std::array<int, 3> seen{};
    for (std::size_t i = 0; i < result.visibility.size(); ++i) {
        int points = 0;
        for (const GnLight& point : both.points) {
            // A little above the ground, which blocks nothing then.
            const dvec3 p_ws = dvec3(samples.position_ws[i]) + dvec3(0, 1e-5, 0);
            points += truth.blocked(p_ws, dvec3(point.position_ws)) ? 0 : 1;
        }
        EXPECT_EQ(result.visibility[i], 0.5F * static_cast<float>(points)) << i;
        EXPECT_EQ(result.standard_error[i], 0.0F);
        ++seen.at(static_cast<std::size_t>(points));
    }
    EXPECT_TRUE(seen[0] > 0 && seen[1] > 0 && seen[2] > 0) << seen[0] << " " << seen[1] << " " << seen[2];
    EXPECT_THROW(static_cast<void>(truth.trace(samples.position_ws, samples.normal_ws, light,
                                               {.integral = true, .exactly = &both, .width = 24})),
                 Error);
}

TEST(Truth, SlabConvergesToItsClosedForm) {
    const Slab slab;
    const Truth truth(slab.quads.scene);
    const Samples samples = ground_samples(96, 1.4F);
    double last = 0;
    const int most = test::sanitized ? 64 : 1024;
    for (int n = 16; n <= most; n *= 4) {
        TruthOptions options;
        options.samples = n;
        const Difference d =
            against(slab, samples, truth.trace(samples.position_ws, samples.normal_ws, slab.light, options));
        // The reported error is the error: over thousands of samples their ratio stays near one.
        EXPECT_NEAR(d.rmse / d.explained, 1.0, 0.08) << n << " samples: rmse " << d.rmse << " reported " << d.explained;
        EXPECT_LT(std::abs(d.mean), 5 * d.explained / 96) << "unbiased";
        // Random points would halve the error per four times the samples; nets do better, about N^-0.75 and more.
        if (last > 0) {
            EXPECT_LT(d.rmse, last / 2.5) << n << " samples";
        }
        last = d.rmse;
    }
    EXPECT_TRUE(test::sanitized || last <= 0.004) << "rmse " << last << " with " << most << " samples";
}

TEST(Truth, HalfPlaneGivesTheLinearRamp) {
    // A half-plane x < 0 at 2 m under a light of width 1 m at 4 m: V rises from 0 to 1 over w d_r/d_o - w = 1 m.
    QuadScene quads;
    quads.add({-10, 0, -10}, {0, 0, 20}, {20, 0, 0});
    quads.add({-10, 2, -10}, {10, 0, 0}, {0, 0, 20});
    const Truth truth(quads.scene);
    Samples samples;
    for (int i = 0; i < 101; ++i) {
        samples.add({-1.0F + 0.02F * static_cast<float>(i), 0, 0.3F}, {0, 1, 0});
    }
    TruthOptions options;
    options.samples = 1024;
    const TruthResult result = truth.trace(samples.position_ws, samples.normal_ws, panel(4, {0.5F, 0.5F}), options);
    for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
        const double expected = std::clamp(static_cast<double>(samples.position_ws[i].x) + 0.5, 0.0, 1.0);
        // One-dimensional nets of 128 points err by at most one point each; eight of them average.
        EXPECT_NEAR(static_cast<double>(result.visibility[i]), expected, 1.0 / 128) << "x " << samples.position_ws[i].x;
    }
}

TEST(Truth, ThreadsChangeNothing) {
    const Slab slab;
    const Truth truth(slab.quads.scene);
    const Samples samples = ground_samples(64, 1.4F);
    TruthOptions options;
    options.samples = 64;
    options.integral = true;
    options.threads = 1;
    const TruthResult one = truth.trace(samples.position_ws, samples.normal_ws, slab.light, options);
    for (const int threads : {2, 3}) {
        options.threads = threads;
        const TruthResult many = truth.trace(samples.position_ws, samples.normal_ws, slab.light, options);
        EXPECT_EQ(one.visibility, many.visibility);
        EXPECT_EQ(one.standard_error, many.standard_error);
        EXPECT_EQ(one.irradiance, many.irradiance);
        EXPECT_EQ(one.mean_standard_error, many.mean_standard_error);
    }
    options.seed = 1;
    EXPECT_NE(one.visibility, truth.trace(samples.position_ws, samples.normal_ws, slab.light, options).visibility);
}

TEST(Truth, SamplesAreRoundedUpToAPowerOfTwoAndBounded) {
    const Slab slab;
    const Truth truth(slab.quads.scene);
    const Samples samples = ground_samples(16, 1.4F);
    TruthOptions options;
    options.samples = 33;
    const TruthResult a = truth.trace(samples.position_ws, samples.normal_ws, slab.light, options);
    options.samples = 64;
    EXPECT_EQ(a.visibility, truth.trace(samples.position_ws, samples.normal_ws, slab.light, options).visibility);
    for (const int bad : {0, -1, (1 << 20) + 1}) {
        options.samples = bad;
        EXPECT_THROW((void)truth.trace(samples.position_ws, samples.normal_ws, slab.light, options), Error);
    }
    options.samples = 1;
    const TruthResult coin = truth.trace(samples.position_ws, samples.normal_ws, slab.light, options);
    EXPECT_EQ(coin.standard_error[0], 0.5F);
}

TEST(Truth, ProgressRisesToOneOnTheCallersThread) {
    const Slab slab;
    const Truth truth(slab.quads.scene);
    const Samples samples = ground_samples(64, 1.4F);
    const auto caller = std::this_thread::get_id();
    double last = 0;
    TruthOptions options;
    options.samples = 8;
    const auto watch = [&](double fraction) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_GE(fraction, last);
        last = fraction;
    };
    (void)truth.trace(samples.position_ws, samples.normal_ws, slab.light, options, watch);
    EXPECT_EQ(last, 1.0);
    // A watcher that gives up ends the work.
    const auto give_up = [](double) { throw std::runtime_error("enough"); };
    EXPECT_THROW((void)truth.trace(samples.position_ws, samples.normal_ws, slab.light, options, give_up),
                 std::runtime_error);
}

TEST(Truth, AStopEndsItBeforeTheNextSample) {
    // A million rays a sample take hours for all of these; every thread asks before each of them.
    const Slab slab;
    const Samples samples = ground_samples(64, 1);
    const Truth truth(slab.quads.scene);
    static std::atomic<int> asked;
    asked = 0;
    TruthOptions options{.samples = 1 << 20, .threads = 2};
    options.stop = [] { return ++asked > 4; };
    const TruthResult stopped = truth.trace(samples.position_ws, samples.normal_ws, slab.light, options);
    EXPECT_FALSE(stopped.complete);
    EXPECT_LT(asked, 16);
    options = {.samples = 4};
    options.stop = [] { return false; };
    EXPECT_TRUE(truth.trace(samples.position_ws, samples.normal_ws, slab.light, options).complete);
}

TEST(Truth, UncountedSamplesStayZero) {
    const Slab slab;
    const Truth truth(slab.quads.scene);
    Samples samples;
    samples.add({3, 0, 0}, {0, 1, 0});
    samples.add({3, 0, 0}, {0, -1, 0});                                       // faces away
    samples.add({std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 1, 0});  // nowhere
    samples.add({3, 0, 0}, {0, 1, 0});
    samples.position_ws.back().w = 0;  // no surface
    const TruthResult result = truth.trace(samples.position_ws, samples.normal_ws, slab.light, {});
    EXPECT_EQ(result.counted, (std::vector<std::uint8_t>{1, 0, 0, 0}));
    EXPECT_EQ(result.visibility, (std::vector<float>{1, 0, 0, 0}));
}

TEST(Truth, IntegralOfTheOpenSkyIsTheLightsIrradiance) {
    QuadScene quads;
    quads.add({-10, 0, -10}, {0, 0, 20}, {20, 0, 0});
    const Truth truth(quads.scene);
    GnLight sun;
    sun.direction_ws = vec4(glm::normalize(vec3(1, -2, 0)), 0);
    sun.angular_radius = 0.2F;
    sun.intensity = 90000;
    TruthOptions options;
    options.integral = true;
    const Samples samples = ground_samples(32, 1);
    const TruthResult result = truth.trace(samples.position_ws, samples.normal_ws, sun, options);
    Running irradiance;
    for (const float value : result.irradiance) {
        irradiance.add(static_cast<double>(value));
    }
    // The view samples are independent experiments: their mean lies within five of its own standard errors.
    EXPECT_GT(irradiance.standard_error(), 0.0);
    EXPECT_NEAR(irradiance.mean(), 90000 * 2 / std::sqrt(5.0), 5 * irradiance.standard_error());
    EXPECT_LT(irradiance.standard_error(), 5.0);
    options.integral = false;
    EXPECT_TRUE(truth.trace(samples.position_ws, samples.normal_ws, sun, options).irradiance.empty());
}

TEST(Truth, BlockedIsTheOpenSegment) {
    const Slab slab;
    const Truth truth(slab.quads.scene);
    EXPECT_TRUE(truth.blocked({0, 1, 0}, {0, 3, 0}));
    EXPECT_TRUE(truth.blocked({0, 3, 0}, {0, 1, 0}));
    EXPECT_FALSE(truth.blocked({0, 0.5, 0}, {0, 1.5, 0}));
    EXPECT_FALSE(truth.blocked({0, 0, 0}, {0, 2, 0})) << "ends lie on surfaces and do not block";
    EXPECT_FALSE(truth.blocked({0.51, 0, 0}, {0.51, 4, 0}));
    EXPECT_TRUE(truth.blocked({0.49, 0, 0}, {0.49, 4, 0}));
    EXPECT_FALSE(truth.blocked({1, 1, 1}, {1, 1, 1}));
}

TEST(Truth, EmptySceneBlocksNothing) {
    Scene scene;
    scene.materials.emplace_back();
    const Truth truth(scene);
    EXPECT_FALSE(truth.blocked({0, 0, 0}, {0, 9, 0}));
    EXPECT_TRUE(truth.trace({}, {}, panel(1, {1, 1}), {}).visibility.empty());
}

}  // namespace
}  // namespace gn::truth_test
