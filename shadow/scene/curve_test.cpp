// SPDX-License-Identifier: MIT
#include "shadow/scene/rig.h"

#include <gtest/gtest.h>

namespace gn::curve_test {
namespace {

void expect_near(dvec3 found, dvec3 wanted, double seconds) {
    EXPECT_LT(glm::distance(found, wanted), 1e-6)
        << "at " << seconds << ": " << found.x << " " << found.y << " " << found.z;
}

TEST(Curve, StepsStandAndLinesRunBetweenKeys) {
    Curve curve{
        .between = Interpolation::step, .times = {1, 2, 4}, .values = {{1, 0, 0, 0}, {3, 5, 0, 0}, {7, 0, 1, 0}}};
    expect_near(vector_at(curve, 0), {1, 0, 0}, 0);
    expect_near(vector_at(curve, 1.99), {1, 0, 0}, 1.99);
    expect_near(vector_at(curve, 2), {3, 5, 0}, 2);
    expect_near(vector_at(curve, 9), {7, 0, 1}, 9);
    curve.between = Interpolation::linear;
    expect_near(vector_at(curve, 0.5), {1, 0, 0}, 0.5);
    expect_near(vector_at(curve, 1.25), {1.5, 1.25, 0}, 1.25);
    expect_near(vector_at(curve, 3), {5, 2.5, 0.5}, 3);
    expect_near(vector_at(curve, 4), {7, 0, 1}, 4);
}

TEST(Curve, ASplineOfACubicsValuesAndSlopesIsTheCubic) {
    // p(t) = 2 t^3 - t^2 + 3 t + 1, with slopes in units a second, over keys that lie unevenly.
    const auto p = [](double t) { return 2 * t * t * t - t * t + 3 * t + 1; };
    const auto slope = [](double t) { return 6 * t * t - 2 * t + 3; };
    Curve curve{.between = Interpolation::cubic_spline, .times = {0.5F, 1, 3}};
    for (const float t : curve.times) {
        const vec4 tangent(static_cast<float>(slope(t)), 0, 0, 0), value(static_cast<float>(p(t)), 0, 0, 0);
        curve.values.insert(curve.values.end(), {tangent, value, tangent});
    }
    for (const double t : {0.5, 0.6, 0.99, 1.0, 1.7, 2.9, 3.0}) {
        EXPECT_NEAR(vector_at(curve, t).x, p(t), 1e-5) << t;
    }
    EXPECT_NEAR(vector_at(curve, 0).x, p(0.5), 1e-6);
    EXPECT_NEAR(vector_at(curve, 5).x, p(3), 1e-6);

    // What arrives at a key is another tangent than what leaves it: v + d b (t^3 - 2 t^2 + t) with all else 0.
    curve = {.between = Interpolation::cubic_spline,
             .times = {0, 2},
             .values = {vec4(9), vec4(0), vec4(4), vec4(0), vec4(0), vec4(9)}};
    EXPECT_NEAR(vector_at(curve, 1).x, 2 * 4 * 0.125, 1e-6);
}

TEST(Curve, RotationsGoTheShorterWayAtAnEvenRate) {
    constexpr float s = 0.70710678F;
    for (const float sign : {1.0F, -1.0F}) {
        // A quarter about z; the quaternion of either sign is the same turn.
        const Curve curve{.times = {0, 1}, .values = {{0, 0, 0, 1}, sign * vec4(0, 0, s, s)}};
        for (const double share : {0.25, 0.5, 1.0}) {
            const double angle = share * glm::half_pi<double>();
            expect_near(rotation_at(curve, share) * dvec3(1, 0, 0), {std::cos(angle), std::sin(angle), 0}, share);
        }
    }
    const Curve none{.times = {0}, .values = {vec4(0)}};
    expect_near(rotation_at(none, 0) * dvec3(1, 2, 3), {1, 2, 3}, 0);
}

}  // namespace
}  // namespace gn::curve_test
