// SPDX-License-Identifier: MIT
// No ray meets the surface that it leaves, at any angle, size and place; contact shadows touch; alpha decides.
#include "reference/occluders.h"

#include "reference/quads_test.h"
#include "reference/truth.h"

#include <gtest/gtest.h>

#include <random>

namespace gn {
namespace {

GnLight sun_towards(vec3 towards, float angular_radius = 0) {
    GnLight light;
    light.kind = GN_LIGHT_DIRECTIONAL;
    light.direction_ws = vec4(-glm::normalize(towards), 0);
    light.angular_radius = angular_radius;
    return light;
}

/// A point of the triangle as a rasterizer makes it: interpolated in float.
vec3 interpolate(const Scene& scene, uvec3 t, vec2 uv) {
    return (1.0F - uv.x - uv.y) * scene.positions_ws[t.x] + uv.x * scene.positions_ws[t.y] +
           uv.y * scene.positions_ws[t.z];
}

Samples random_samples(const Scene& scene, vec3 normal, int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    Samples samples;
    for (int i = 0; i < count; ++i) {
        vec2 uv(unit(random), unit(random));
        if (uv.x + uv.y > 1) {
            uv = 1.0F - uv;
        }
        samples.add(interpolate(scene, scene.triangles[random() % scene.triangles.size()], uv), normal);
    }
    return samples;
}

std::size_t count_dark(const TruthResult& result, std::size_t& counted) {
    std::size_t dark = 0;
    counted = 0;
    for (std::size_t i = 0; i < result.visibility.size(); ++i) {
        counted += result.counted[i];
        dark += result.counted[i] != 0 && result.visibility[i] < 1.0F ? 1U : 0U;
    }
    return dark;
}

TEST(Occluders, APlaneNeverShadowsItselfAtAnyAngleSizeOrPlace) {
    // The plane's normal is `degrees` from the light's direction, which is oblique to the axes, as is the plane.
    const vec3 towards = glm::normalize(vec3(0.3F, 0.8F, -0.5F));
    vec3 x;
    vec3 y;
    complete_frame(towards, x, y);
    for (const float degrees : {0.0F, 30.0F, 60.0F, 80.0F, 85.0F, 89.0F, 89.9F}) {
        const float angle = glm::radians(degrees);
        const vec3 normal = std::cos(angle) * towards + std::sin(angle) * x;
        const vec3 along = std::cos(angle) * x - std::sin(angle) * towards;
        for (const float size : {0.01F, 1.0F, 1000.0F}) {
            for (const vec3 place : {vec3(0), vec3(10, 3, -7), vec3(3000, -200, 5000)}) {
                QuadScene quads;
                quads.add(place - 0.5F * size * (along + y), size * y, size * along);
                const Truth truth(quads.scene);
                const Samples samples = random_samples(quads.scene, normal, 300, 1);
                std::size_t counted = 0;
                for (const float radius : {0.0F, 0.001F}) {
                    const TruthResult result = truth.trace(samples.position_ws, samples.normal_ws,
                                                           sun_towards(towards, radius), {.samples = 16});
                    EXPECT_EQ(count_dark(result, counted), 0U)
                        << degrees << " degrees, size " << size << ", place " << place.x << ", radius " << radius;
                    EXPECT_EQ(counted, samples.position_ws.size());
                }
            }
        }
    }
}

TEST(Occluders, AFacetedSphereNeverShadowsItsLitSide) {
    // A convex body: every counted sample sees the light, close to the terminator and to the facets' edges too.
    Scene scene;
    scene.materials.emplace_back();
    constexpr int rings = 24;
    constexpr int sides = 48;
    const vec3 centre(12, 5, -30);
    for (int r = 0; r <= rings; ++r) {
        for (int s = 0; s < sides; ++s) {
            const float theta = pi * static_cast<float>(r) / rings;
            const float phi = 2 * pi * static_cast<float>(s) / sides;
            scene.positions_ws.push_back(
                centre + vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
        }
    }
    for (uint r = 0; r < rings; ++r) {
        for (uint s = 0; s < sides; ++s) {
            const uint a = r * sides + s;
            const uint b = r * sides + (s + 1) % sides;
            if (r > 0) {
                scene.triangles.emplace_back(a, b, b + sides);
            }
            if (r + 1 < rings) {
                scene.triangles.emplace_back(a, b + sides, a + sides);
            }
        }
    }
    scene.objects.push_back({"", 0, static_cast<uint>(scene.triangles.size()), 0, {}});
    const Truth truth(scene);

    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    Samples samples;
    for (int i = 0; i < 20000; ++i) {
        const uvec3 t = scene.triangles[random() % scene.triangles.size()];
        const vec3 n = glm::cross(scene.positions_ws[t.y] - scene.positions_ws[t.x],
                                  scene.positions_ws[t.z] - scene.positions_ws[t.x]);
        const vec3 p =
            interpolate(scene, t, vec2(unit(random), unit(random)) * (i % 2 == 0 ? vec2(0.5F) : vec2(1, 1e-5F)));
        samples.add(p, glm::normalize(glm::dot(n, p - centre) > 0 ? n : -n));
    }
    const TruthResult result = truth.trace(samples.position_ws, samples.normal_ws, sun_towards({1, 0.2F, 0.4F}), {});
    std::size_t counted = 0;
    EXPECT_EQ(count_dark(result, counted), 0U);
    EXPECT_GT(counted, 8000U);
}

TEST(Occluders, ContactShadowsTouch) {
    // A thin wall stands on the ground; a tenth of a millimetre beside it one side is dark and the other lit.
    QuadScene quads;
    quads.add({-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
    quads.add({0, 0, -1}, {0, 0, 2}, {0, 1, 0});
    const Truth truth(quads.scene);
    Samples samples;
    for (const float x : {-1e-4F, 1e-4F}) {
        samples.add({x, 0, 0.1F}, {0, 1, 0});
    }
    const TruthResult result = truth.trace(samples.position_ws, samples.normal_ws, sun_towards({1, 1, 0}), {});
    EXPECT_EQ(result.visibility, (std::vector<float>{0, 1}));
}

TEST(Occluders, SamplesOffTheirSurfaceByRoundingAreSeated) {
    QuadScene quads;
    quads.add({-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
    const Occluders occluders(quads.scene);
    for (const double error : {-1e-4, 0.0, 1e-4}) {
        const Seat seat = occluders.seat({3, error, 4}, {0, 1, 0});
        EXPECT_NEAR(seat.p_ws.y, 0.0, 1e-12);
        EXPECT_GT(seat.origin_ws.y, 0.0F);
        EXPECT_LT(seat.origin_ws.y, 1e-5F);
    }
    // A millimetre is no rounding error at this scale: such a sample stays.
    EXPECT_EQ(occluders.seat({3, 1e-3, 4}, {0, 1, 0}).p_ws.y, 1e-3);
    // A surface at an angle is not the sample's own.
    EXPECT_EQ(occluders.seat({3, 1e-5, 4}, glm::normalize(dvec3(1, 1, 0))).p_ws.y, 1e-5);
}

/// A sheet at 1 m with a texture of 2 x 1 texels, opaque at u = 0.25 and clear at u = 0.75.
QuadScene sheet(AlphaMode mode, float cutoff, float base_alpha, bool repeat) {
    QuadScene quads;
    Texture texture;
    texture.image = {2, 1, {255, 255, 255, 255, 255, 255, 255, 0}};
    texture.repeat_u = texture.repeat_v = repeat;
    quads.scene.textures.push_back(texture);
    Material leaf;
    leaf.alpha_mode = mode;
    leaf.alpha_cutoff = cutoff;
    leaf.base_color.a = base_alpha;
    leaf.base_color_texture = 0;
    quads.scene.materials.push_back(leaf);
    quads.add({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 1);
    return quads;
}

bool blocked_at(const QuadScene& quads, double x) {
    return Truth(quads.scene).blocked({x, 0, 0.5}, {x, 2, 0.5});
}

TEST(Occluders, AlphaMaskLetsRaysThroughWhereItIsClear) {
    const QuadScene mask = sheet(AlphaMode::mask, 0.5F, 1, false);
    EXPECT_TRUE(blocked_at(mask, 0.1));
    EXPECT_FALSE(blocked_at(mask, 0.9));
    // Bilinear: alpha falls linearly from 1 at 0.25 to 0 at 0.75, so the cutoff of a half lies at 0.5.
    EXPECT_TRUE(blocked_at(mask, 0.499));
    EXPECT_FALSE(blocked_at(mask, 0.501));
    // And of a quarter at 0.625.
    const QuadScene low = sheet(AlphaMode::mask, 0.25F, 1, false);
    EXPECT_TRUE(blocked_at(low, 0.624));
    EXPECT_FALSE(blocked_at(low, 0.626));
}

TEST(Occluders, AlphaWrapsAsTheTextureSays) {
    // Repeating, the clear texel reaches over the left border: alpha at u = 0 is one half, not one.
    const QuadScene repeated = sheet(AlphaMode::mask, 0.6F, 1, true);
    EXPECT_FALSE(blocked_at(repeated, 0.01));
    EXPECT_TRUE(blocked_at(repeated, 0.2));
    EXPECT_TRUE(blocked_at(sheet(AlphaMode::mask, 0.6F, 1, false), 0.01));
}

TEST(Occluders, AlphaModesAndFactors) {
    EXPECT_TRUE(blocked_at(sheet(AlphaMode::opaque, 0.5F, 1, false), 0.9)) << "opaque ignores alpha";
    EXPECT_TRUE(blocked_at(sheet(AlphaMode::blend, 0.9F, 1, false), 0.45)) << "blend cuts at one half";
    EXPECT_FALSE(blocked_at(sheet(AlphaMode::blend, 0.1F, 1, false), 0.55));
    EXPECT_FALSE(blocked_at(sheet(AlphaMode::mask, 0.5F, 0.4F, false), 0.1)) << "the factor multiplies";
    EXPECT_FALSE(blocked_at(sheet(AlphaMode::mask, 1.5F, 1, false), 0.1)) << "nothing reaches a cutoff above one";
    EXPECT_TRUE(blocked_at(sheet(AlphaMode::mask, 0.0F, 1, false), 0.9)) << "everything reaches zero";
    // Without a texture the factor decides alone.
    QuadScene plain = sheet(AlphaMode::mask, 0.5F, 0.6F, false);
    plain.scene.materials[1].base_color_texture = -1;
    EXPECT_TRUE(blocked_at(plain, 0.9));
}

TEST(Occluders, RaysUnderTheHorizonAreTracedAsTheyAre) {
    // Half of the light is below the receiver's plane. The plane itself does not block; what lies beneath does.
    QuadScene quads;
    quads.add({-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
    GnLight light;
    light.kind = GN_LIGHT_POINT;
    light.position_ws = vec4(5, 0.01F, 0, 0);
    light.radius = 1;
    Samples samples;
    samples.add({0, 0, 0}, {0, 1, 0});
    EXPECT_EQ(Truth(quads.scene).trace(samples.position_ws, samples.normal_ws, light, {}).visibility[0], 1.0F);
    quads.add({2, -3, -3}, {0, 3, 0}, {0, 0, 6});
    // The cone of 1 in 5 stands 0.01 in 5 above the horizon: so much of its disc's middle is above, too.
    const TruthResult half = Truth(quads.scene).trace(samples.position_ws, samples.normal_ws, light, {});
    const double above = 0.5 + 2 / std::numbers::pi * (0.01 / 5) / std::asin(0.2);
    EXPECT_NEAR(half.visibility[0], above, 4 * static_cast<double>(half.standard_error[0]));
    EXPECT_LT(half.standard_error[0], 0.01F);
}

}  // namespace
}  // namespace gn
