// SPDX-License-Identifier: MIT
// The points that stand for a light: where they lie, what they weigh, who takes which.
#include "shadow/scene/light_samples.h"

#include "base/math.h"

#include <gtest/gtest.h>

#include <numeric>

namespace gn::light_samples_test {
namespace {

GnLight light_of(uint kind) {
    GnLight light;
    light.kind = kind;
    light.position_ws = vec4(1, 2, 3, 1);
    light.direction_ws = vec4(0.6F, -0.8F, 0, 0);
    light.right_ws = vec4(0, 0, 1, 0);
    light.up_ws = vec4(0.8F, 0.6F, 0, 0);
    light.half_size = vec2(0.5F, 0.25F);
    light.radius = 0.5F;
    light.angular_radius = 0.2F;
    light.range = 7;
    return light;
}

TEST(LightSamples, LieOnTheLightAndHaveNoExtent) {
    for (const uint kind : {GN_LIGHT_DIRECTIONAL, GN_LIGHT_SPOT, GN_LIGHT_POINT, GN_LIGHT_RECTANGLE}) {
        const GnLight light = light_of(kind);
        const vec3 axis(light.direction_ws);
        const LightSamples samples = light_samples(light, 64);
        ASSERT_EQ(samples.points.size(), 64U);
        vec3 mean(0);
        for (const GnLight& one : samples.points) {
            const vec3 d = vec3(one.position_ws) - vec3(light.position_ws);
            EXPECT_EQ(one.kind, kind == GN_LIGHT_DIRECTIONAL ? uint(GN_LIGHT_DIRECTIONAL) : uint(GN_LIGHT_POINT));
            EXPECT_EQ(one.radius + one.angular_radius + one.half_size.x + one.half_size.y, 0.0F);
            EXPECT_EQ(one.range, 0.0F);
            mean += (kind == GN_LIGHT_DIRECTIONAL ? vec3(one.direction_ws) - axis : d) / 64.0F;
            switch (kind) {
                case GN_LIGHT_DIRECTIONAL:
                    EXPECT_GE(glm::dot(vec3(one.direction_ws), axis), std::cos(light.angular_radius) - 1e-6F);
                    break;
                case GN_LIGHT_POINT: EXPECT_NEAR(glm::length(d), light.radius, 1e-5F); break;
                case GN_LIGHT_SPOT:
                    EXPECT_NEAR(glm::dot(d, axis), 0, 1e-6F);
                    EXPECT_LE(glm::length(d), light.radius * 1.0001F);
                    break;
                default:
                    EXPECT_NEAR(glm::dot(d, axis), 0, 1e-6F);
                    EXPECT_LE(std::abs(glm::dot(d, vec3(light.right_ws))), light.half_size.x);
                    EXPECT_LE(std::abs(glm::dot(d, vec3(light.up_ws))), light.half_size.y);
            }
        }
        // 64 points of a (0,2)-sequence: their mean is the centre's to about a 64th of the extent.
        EXPECT_LT(glm::length(mean), 0.5F / 32) << kind;
    }
}

TEST(LightSamples, ALightWithoutExtentIsItsCentre) {
    for (const uint kind : {GN_LIGHT_DIRECTIONAL, GN_LIGHT_SPOT, GN_LIGHT_POINT, GN_LIGHT_RECTANGLE}) {
        GnLight light = light_of(kind);
        light.radius = light.angular_radius = 0;
        light.half_size = vec2(0);
        const LightSamples samples = light_samples(light, 64, 8);
        ASSERT_EQ(samples.points.size(), 1U);
        EXPECT_EQ(vec3(samples.points[0].position_ws), vec3(light.position_ws));
        EXPECT_EQ(vec3(samples.points[0].direction_ws), vec3(light.direction_ws));
        EXPECT_EQ(gn_point_weight(light, samples.points[0], vec3(0)), 1.0F);
        EXPECT_TRUE(gn_point_taken(0, 1, ivec2(3, 5), 8));
    }
}

TEST(LightSamples, PointsOfASphereWeighTheSolidAngleOfTheirPatch) {
    // V is uniform over the cone that a sphere subtends. The share of that cone within half its height of the axis is one
    // half, whatever the distance, and the weights' sum times the patch, 4 pi r^2 / N, over d^2 is the cone's solid angle.
    const GnLight light = light_of(GN_LIGHT_POINT);
    const int count = 4096;
    for (const float distance : {0.6F, 1.0F, 5.0F}) {
        const vec3 p_ws = vec3(light.position_ws) + distance * glm::normalize(vec3(1, -2, 0.5F));
        const vec3 axis = glm::normalize(vec3(light.position_ws) - p_ws);
        const float sine = light.radius / distance;
        const double height = 1 - std::sqrt(1 - double{sine} * double{sine});
        double all = 0;
        double inner = 0;
        for (const GnLight& one : light_samples(light, count).points) {
            const double weight = gn_point_weight(light, one, p_ws);
            const double below = 1 - glm::dot(axis, glm::normalize(vec3(one.position_ws) - p_ws));
            all += weight;
            inner += below < 0.5 * height ? weight : 0;
        }
        const double patch = 4 * std::numbers::pi * double{sine} * double{sine} / count;
        // An edge of the cap crosses about sqrt(N) of the points' cells.
        EXPECT_NEAR(inner / all, 0.5, 2 / std::sqrt(count)) << distance;
        EXPECT_NEAR(all * patch, 2 * std::numbers::pi * height, 0.03 * 2 * std::numbers::pi * height) << distance;
    }
}

TEST(LightSamples, FromInsideASphereEveryDirectionWeighsAlike) {
    const GnLight light = light_of(GN_LIGHT_POINT);
    const vec3 p_ws = vec3(light.position_ws) + vec3(0.2F, 0.1F, 0);
    vec3 sum(0);
    float all = 0;
    for (const GnLight& one : light_samples(light, 4096).points) {
        const float weight = gn_point_weight(light, one, p_ws);
        sum += weight * glm::normalize(vec3(one.position_ws) - p_ws);
        all += weight;
    }
    EXPECT_LT(glm::length(sum) / all, 0.02F);
}

TEST(LightSamples, PixelsOfASquareShareThePointsOut) {
    // Each point is taken by exactly one pixel of the square, each pixel takes a run of as many as the others.
    for (const int count : {16, 64, 100}) {
        std::vector<int> takers(static_cast<std::size_t>(count), 0);
        for (int y = 8; y < 12; ++y) {
            for (int x = 4; x < 8; ++x) {
                int taken = 0;
                for (int i = 0; i < count; ++i) {
                    const bool takes = gn_point_taken(i, count, ivec2(x, y), 4);
                    takers[static_cast<std::size_t>(i)] += takes ? 1 : 0;
                    taken += takes ? 1 : 0;
                }
                EXPECT_TRUE(taken == count / 16 || taken == count / 16 + 1) << taken << " of " << count;
            }
        }
        EXPECT_EQ(takers, std::vector<int>(static_cast<std::size_t>(count), 1));
        EXPECT_TRUE(gn_point_taken(count - 1, count, ivec2(3, 7), 1));
    }
}

}  // namespace
}  // namespace gn::light_samples_test
