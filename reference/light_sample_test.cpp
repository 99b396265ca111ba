// SPDX-License-Identifier: MIT
#include "reference/light_sample.h"

#include <gtest/gtest.h>

namespace gn::light_sample_test {
namespace {

constexpr unsigned count = 4096;

GnLight sun(float angular_radius) {
    GnLight light;
    light.kind = GN_LIGHT_DIRECTIONAL;
    light.direction_ws = vec4(glm::normalize(vec3(0.3F, -1.0F, 0.2F)), 0);
    light.angular_radius = angular_radius;
    light.intensity = 1000;
    return light;
}

GnLight spot(float radius) {
    GnLight light;
    light.kind = GN_LIGHT_SPOT;
    light.position_ws = vec4(1, 4, -2, 0);
    light.direction_ws = vec4(glm::normalize(vec3(0.1F, -1.0F, 0.3F)), 0);
    light.radius = radius;
    light.intensity = 500;
    light.cos_outer = 0.2F;
    light.cos_inner = 0.3F;
    return light;
}

GnLight bulb(float radius) {
    GnLight light;
    light.kind = GN_LIGHT_POINT;
    light.position_ws = vec4(1, 4, -2, 0);
    light.radius = radius;
    light.intensity = 500;
    return light;
}

GnLight panel(vec2 half_size) {
    GnLight light;
    light.kind = GN_LIGHT_RECTANGLE;
    light.position_ws = vec4(0, 3, 0, 0);
    light.direction_ws = vec4(0, -1, 0, 0);
    light.half_size = half_size;
    light.intensity = 200;
    return light;
}

dvec3 mean_point(const GnLight& light, vec3 p_ws) {
    dvec3 sum(0);
    for (unsigned i = 0; i < count; ++i) {
        const LightPoint point = sample_light(light, p_ws, sobol_owen(i, 3));
        EXPECT_NEAR(glm::length(point.direction_ws), 1.0F, 2e-6F);
        sum += dvec3(p_ws) + static_cast<double>(point.distance) * dvec3(point.direction_ws);
    }
    return sum / static_cast<double>(count);
}

double mean_irradiance(const GnLight& light, vec3 p_ws, vec3 n_ws) {
    const LightSampler sampler(light, p_ws);
    double sum = 0;
    for (unsigned i = 0; i < count; ++i) {
        const LightPoint point = sampler.single() ? sampler.centre() : sampler.at(sobol_owen(i, 3));
        sum += static_cast<double>(sampler.irradiance(point, n_ws));
    }
    return sum / count;
}

TEST(LightSample, DiscIsUniformAndConcentric) {
    // A quarter of the points in the disc of half the radius, a quarter in each quadrant, mean in the centre.
    dvec2 mean(0);
    unsigned inner = 0;
    unsigned quadrant = 0;
    for (unsigned i = 0; i < count; ++i) {
        const vec2 d = disc_from_square(sobol_owen(i, 7));
        ASSERT_LE(glm::length(d), 1.0F + 1e-6F);
        mean += dvec2(d) / static_cast<double>(count);
        inner += glm::length(d) < 0.5F ? 1U : 0U;
        quadrant += d.x > 0 && d.y > 0 ? 1U : 0U;
    }
    EXPECT_NEAR(inner, count / 4, count / 200);
    EXPECT_NEAR(quadrant, count / 4, count / 200);
    EXPECT_LT(glm::length(mean), 2e-3);
}

TEST(LightSample, DiscMeetsTheExactMap) {
    // At the corner of the square the angle is exactly 45 degrees, at the middle of a side 0 and 90.
    EXPECT_NEAR(glm::length(disc_from_square({0.999999F, 0.999999F}) - vec2(std::sqrt(0.5F))), 0, 1e-5);
    EXPECT_NEAR(glm::length(disc_from_square({1.0F, 0.5F}) - vec2(1, 0)), 0, 1e-7);
    EXPECT_NEAR(glm::length(disc_from_square({0.5F, 0.0F}) - vec2(0, -1)), 0, 1e-7);
    EXPECT_EQ(disc_from_square({0.5F, 0.5F}), vec2(0));
}

TEST(LightSample, SpotPointsFormItsDisc) {
    const GnLight light = spot(0.5F);
    const vec3 p(0.2F, 0, 0.4F);
    EXPECT_LT(glm::length(mean_point(light, p) - dvec3(vec3(light.position_ws))), 2e-3);
    for (unsigned i = 0; i < 256; ++i) {
        const LightPoint point = sample_light(light, p, sobol_owen(i, 5));
        const vec3 offset = p + point.distance * point.direction_ws - vec3(light.position_ws);
        EXPECT_NEAR(glm::dot(offset, vec3(light.direction_ws)), 0.0F, 2e-6F);
        EXPECT_LE(glm::length(offset), 0.5F + 2e-6F);
    }
}

TEST(LightSample, RectangleIsUniformOverItsArea) {
    const GnLight light = panel({0.75F, 0.25F});
    const vec3 p(2, 0, 1);
    EXPECT_LT(glm::length(mean_point(light, p) - dvec3(0, 3, 0)), 1e-3);
    double x2 = 0;
    for (unsigned i = 0; i < count; ++i) {
        const LightPoint point = sample_light(light, p, sobol_owen(i, 5));
        const vec3 q = p + point.distance * point.direction_ws;
        ASSERT_LE(std::abs(q.x), 0.75F + 1e-5F);
        ASSERT_LE(std::abs(q.z), 0.25F + 1e-5F);
        x2 += static_cast<double>(q.x) * static_cast<double>(q.x) / count;
    }
    EXPECT_NEAR(x2, 0.75 * 0.75 / 3, 1e-3);
}

TEST(LightSample, SphereIsUniformOverItsConeAndEndsOnItsNearSide) {
    const GnLight light = bulb(0.5F);
    const vec3 p(0.2F, 0, 0.4F);
    const vec3 centre(light.position_ws);
    const double distance = static_cast<double>(glm::length(centre - p));
    const double cos_cone = std::sqrt(1.0 - 0.25 / (distance * distance));
    double mean_cosine = 0;
    for (unsigned i = 0; i < count; ++i) {
        const LightPoint point = sample_light(light, p, sobol_owen(i, 5));
        const vec3 q = p + point.distance * point.direction_ws;
        EXPECT_NEAR(glm::length(q - centre), 0.5F, 5e-4F);
        const double cosine =
            static_cast<double>(glm::dot(point.direction_ws, (centre - p) / static_cast<float>(distance)));
        ASSERT_GE(cosine, cos_cone - 1e-6);
        ASSERT_LE(glm::dot(q - centre, point.direction_ws), 1e-4F);
        mean_cosine += cosine / count;
    }
    // The cosine of a uniform direction in a cone is itself uniform.
    EXPECT_NEAR(mean_cosine, 0.5 * (1.0 + cos_cone), 1e-5);
}

TEST(LightSample, SunIsUniformOverItsConeEvenWhenItIsNarrow) {
    for (const float angle : {0.00465F, 0.1F, 1.2F}) {
        const GnLight light = sun(angle);
        const dvec3 axis = -dvec3(vec3(light.direction_ws));
        double mean_height = 0;
        for (unsigned i = 0; i < count; ++i) {
            const LightPoint point = sample_light(light, vec3(0), sobol_owen(i, 5));
            ASSERT_TRUE(std::isinf(point.distance));
            // 1 - cos = 2 sin^2(half angle) = |d - axis|^2 / 2, without cancellation.
            const dvec3 chord = glm::normalize(dvec3(point.direction_ws)) - axis;
            mean_height += 0.5 * glm::dot(chord, chord) / count;
        }
        const double height = 2.0 * std::pow(std::sin(0.5 * static_cast<double>(angle)), 2);
        EXPECT_NEAR(mean_height / height, 0.5, 2e-3) << "angle " << angle;
    }
}

TEST(LightSample, IrradianceOfClosedForms) {
    const vec3 up(0, 1, 0);
    // A sun of any radius above the horizon: E cos(theta), exactly, since its disc's mean direction is its axis.
    EXPECT_NEAR(mean_irradiance(sun(0.3F), vec3(0), up), 1000.0 * static_cast<double>(-sun(0.3F).direction_ws.y), 0.5);
    // A sphere lights an unobstructed surface like a point (the inverse square law holds exactly for it).
    const vec3 p(0.2F, 0, 0.4F);
    EXPECT_NEAR(mean_irradiance(bulb(1.0F), p, up), mean_irradiance(bulb(0.0F), p, up), 2e-2);
    EXPECT_NEAR(mean_irradiance(bulb(0.0F), vec3(1, 0, -2), up), 500.0 / 16.0, 1e-3);
    // A square of side 2a facing the receiver at distance d: the configuration factor from its centre times pi L.
    const double a = 1.0 / 3.0;
    const double quarter = a / std::sqrt(1 + a * a) * std::atan(a / std::sqrt(1 + a * a)) * 2;
    EXPECT_NEAR(mean_irradiance(panel({1, 1}), vec3(0), up), 200.0 * 0.5 * 4 * quarter, 0.02);
    // Within the inner cone a spot is a point: its candela over the squared distance, times the cosine.
    const vec3 under(1, 1, -2);
    const float height = spot(0).position_ws.y - under.y;
    EXPECT_NEAR(mean_irradiance(spot(0), under, up), static_cast<double>(spot(0).intensity / (height * height)), 1e-3);
    // Its disc shrinks to its point.
    EXPECT_NEAR(mean_irradiance(spot(0.01F), p, up), mean_irradiance(spot(0.0F), p, up), 1e-2);
}

TEST(LightSample, NoExtentIsOneExactPoint) {
    for (const GnLight& light : {sun(0), spot(0), bulb(0), panel({0, 0})}) {
        const vec3 p(0.5F, 0, 0.25F);
        const LightPoint point = sample_light(light, p, {0.1F, 0.9F});
        EXPECT_LT(glm::length(point.direction_ws - gn_to_light(light, p)), 1e-6F);
    }
}

TEST(LightSample, InsideTheSphereAllDirectionsMeetIt) {
    const GnLight light = bulb(2.0F);
    const vec3 p(0.5F, 4.5F, -2);
    dvec3 mean(0);
    for (unsigned i = 0; i < count; ++i) {
        const LightPoint point = sample_light(light, p, sobol_owen(i, 5));
        EXPECT_NEAR(glm::length(p + point.distance * point.direction_ws - vec3(light.position_ws)), 2.0F, 1e-4F);
        mean += dvec3(point.direction_ws) / static_cast<double>(count);
    }
    EXPECT_LT(glm::length(mean), 2e-3);
}

}  // namespace
}  // namespace gn::light_sample_test
