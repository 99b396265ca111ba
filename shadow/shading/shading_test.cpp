// SPDX-License-Identifier: MIT
// Illuminance by its units, and what any reflectance must keep: reciprocity and energy.
#include "shadow/shading/shading.glsl"

#include "base/math.h"
#include "shadow/shading/tonemap.h"

#include <gtest/gtest.h>

namespace gn::shading_test {
namespace {

using namespace gn::glsl;

GnLight lamp(int kind) {
    GnLight light;
    light.kind = static_cast<uint>(kind);
    light.position_ws = vec4(0, 2, 0, 1);
    light.direction_ws = vec4(0, -1, 0, 0);
    light.intensity = 12;
    return light;
}

TEST(Illuminance, FollowsTheUnits) {
    // 12 lux are 12 lux; 12 cd two metres away are 3 lux, and 0.75 lux at twice that.
    EXPECT_EQ(gn_illuminance(lamp(GN_LIGHT_DIRECTIONAL), vec3(0)), 12.0F);
    EXPECT_FLOAT_EQ(gn_illuminance(lamp(GN_LIGHT_POINT), vec3(0)), 3.0F);
    EXPECT_FLOAT_EQ(gn_illuminance(lamp(GN_LIGHT_POINT), vec3(0, -2, 0)), 0.75F);

    // 12 cd/m^2 over 2 x 0.5 m are 12 cd along the axis, by the cosine beside it, and nothing behind.
    GnLight panel = lamp(GN_LIGHT_RECTANGLE);
    panel.half_size = vec2(1, 0.25F);
    EXPECT_FLOAT_EQ(gn_illuminance(panel, vec3(0)), 3.0F);
    EXPECT_FLOAT_EQ(gn_illuminance(panel, vec3(2, 0, 0)), 12.0F / 8.0F * std::sqrt(0.5F));
    EXPECT_EQ(gn_illuminance(panel, vec3(0, 4, 0)), 0.0F);
}

TEST(Illuminance, FadesToTheConeAndToTheRange) {
    // The squared ramp of the cosine is a quarter half way between the cones.
    GnLight spot = lamp(GN_LIGHT_SPOT);
    spot.cos_inner = 1.0F;
    spot.cos_outer = 0.6F;
    EXPECT_FLOAT_EQ(gn_illuminance(spot, vec3(0)), 3.0F);
    EXPECT_NEAR(gn_illuminance(spot, vec3(1.5F, 0, 0)), 12.0F / 6.25F * 0.25F, 1e-5F);  // cosine 0.8; rounding of it
    EXPECT_EQ(gn_illuminance(spot, vec3(4, 0, 0)), 0.0F);

    // glTF's window is 1 - (d / range)^4.
    GnLight bulb = lamp(GN_LIGHT_POINT);
    bulb.range = 4;
    EXPECT_FLOAT_EQ(gn_illuminance(bulb, vec3(0)), 3.0F * (1 - 1.0F / 16));
    EXPECT_EQ(gn_illuminance(bulb, vec3(0, -3, 0)), 0.0F);
}

vec3 direction(float polar, float azimuth) {
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
}

/// Share of white light from one direction that a surface sends on into all directions.
double albedo(float polar, float roughness, float metallic) {
    constexpr int steps = 120;
    const vec3 n_ws(0, 1, 0);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        for (int k = 0; k < steps; ++k) {
            // Equal shares of the solid angle, in the cosine and the azimuth.
            const float cosine = (static_cast<float>(i) + 0.5F) / steps;
            const vec3 l = direction(std::acos(cosine), 2 * pi * (static_cast<float>(k) + 0.5F) / steps);
            const vec3 f = gn_reflect(n_ws, direction(polar, 0), l, vec3(1), roughness, metallic);
            sum += static_cast<double>(f.x) * 2 * static_cast<double>(pi) / (steps * steps);
        }
    }
    return sum;
}

TEST(Reflectance, OfMetalNeverSendsOnMoreThanItGets) {
    for (const float polar : {0.0F, 0.7F, 1.2F}) {
        for (const float roughness : {0.4F, 0.7F, 1.0F}) {
            // One half percent for the sum's steps, each a small part of the lobe.
            EXPECT_LE(albedo(polar, roughness, 1), 1.005) << polar << " " << roughness;
        }
    }
}

TEST(Reflectance, OfADielectricNeitherUnlessSeenAtGrazingAngles) {
    // What is scattered loses Fresnel's share at the half vector, as glTF has it: at 69 degrees that is a twentieth too
    // little. Up to 40 degrees it is whole.
    for (const float roughness : {0.4F, 0.7F, 1.0F}) {
        EXPECT_LE(albedo(0.0F, roughness, 0), 1.005) << roughness;
        EXPECT_LE(albedo(0.7F, roughness, 0), 1.005) << roughness;
        EXPECT_LE(albedo(1.2F, roughness, 0), 1.06) << roughness;
    }
}

TEST(Reflectance, OfMetalAlongTheNormalHasAClosedForm) {
    // At roughness 1 the distribution is 1 / pi and the shadowing 1 / (2 (1 + l)): the integral of l / (1 + l) over the
    // cosine l is 1 - ln 2, to a thousandth for the sum's steps. A smoother lobe is hardly shadowed.
    EXPECT_NEAR(albedo(0.0F, 1.0F, 1.0F), 1 - std::numbers::ln2, 1e-3);
    EXPECT_GT(albedo(0.0F, 0.4F, 1.0F), 0.95);
}

TEST(Reflectance, IsReciprocal) {
    const vec3 n_ws(0, 1, 0);
    for (const float roughness : {0.3F, 1.0F}) {
        for (const float metallic : {0.0F, 1.0F}) {
            const vec3 a = direction(0.4F, 0.3F), b = direction(1.1F, 2.0F);
            const float there = gn_reflect(n_ws, a, b, vec3(0.5F), roughness, metallic).x / b.y;
            const float back = gn_reflect(n_ws, b, a, vec3(0.5F), roughness, metallic).x / a.y;
            EXPECT_NEAR(there, back, 1e-5F * there) << roughness << " " << metallic;  // rounding of a dozen products
        }
    }
}

TEST(Reflectance, OfADullSurfaceIsLambertsLessFresnels) {
    // Light and eye along the normal: diffuse 1 / pi less the 4 % that a dielectric reflects, and a lobe of 0.04 / 4 pi.
    const vec3 n_ws(0, 1, 0);
    const float found = gn_reflect(n_ws, n_ws, n_ws, vec3(1), 1.0F, 0.0F).x;
    EXPECT_NEAR(found, (0.96F + 0.04F / 4) / pi, 1e-5F);
}

TEST(Tonemap, IsLinearBelowItsKneeAndTheLogAverageBecomesMiddleGrey) {
    Image radiance(2, 1, 3);
    radiance.values = {2, 2, 2, 8, 8, 8};
    const float exposure = automatic_exposure(radiance);
    EXPECT_NEAR(exposure, 0.18F / 4, 1e-6F);  // the geometric mean of 2 and 8 is 4
    const Image display = tonemap(radiance, exposure);
    EXPECT_NEAR(display.at(0, 0, 0), srgb_from_linear(0.09F), 1e-6F);
    EXPECT_NEAR(display.at(1, 0, 0), srgb_from_linear(0.36F), 1e-6F);
    EXPECT_LT(tonemap(radiance, 100.0F).at(1, 0, 0), 1.0001F);
}

}  // namespace
}  // namespace gn::shading_test
