// SPDX-License-Identifier: MIT
// No ray meets the surface that it leaves, at any angle, size and place; contact shadows touch; alpha decides.
#include "reference/occluders.h"

#include "reference/quads_test.h"
#include "reference/truth.h"

#include <gtest/gtest.h>

#include <random>

namespace gn::occluders_test {
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

/// A ground of 100 km and a sheet of 2 m that hovers `gap` above it, 40 km from the middle, both turned about the middle.
struct WideWorld {
    QuadScene quads;
    dmat4 turn;
    WideWorld(double gap, double degrees)
        : turn(glm::rotate(dmat4(1.0), glm::radians(degrees), glm::normalize(dvec3(1, 0, 0.3)))) {
        add({-5e4, 0, -5e4}, {0, 0, 1e5}, {1e5, 0, 0});
        add({4e4 - 1, gap, -1}, {0, 0, 2}, {2, 0, 0});
    }
    void add(dvec3 corner, dvec3 a, dvec3 b) {
        quads.add({}, {}, {});
        for (std::size_t i = 0; const dvec2 uv : {dvec2(0, 0), dvec2(1, 0), dvec2(1, 1), dvec2(0, 1)}) {
            quads.scene.positions_ws[quads.scene.positions_ws.size() - 4 + i++] = placed(corner + uv.x * a + uv.y * b);
        }
    }
    [[nodiscard]] vec3 placed(dvec3 p) const { return vec3(turn * dvec4(p, 1.0)); }
    [[nodiscard]] vec3 turned(vec3 d) const { return vec3(turn * dvec4(dvec3(d), 0.0)); }
};

TEST(Occluders, ASlabJustAboveAWideGroundCastsItsShadow) {
    // The turned ground is known to a few millimetres only, half a unit of 4 ... 5 * 10^4; the level one exactly.
    for (const auto& [degrees, gap] : {std::pair{0.0, 1e-3}, {0.0, 0.05}, {20.0, 0.05}, {75.0, 0.05}}) {
        const WideWorld world(gap, degrees);
        const Truth truth(world.quads.scene);
        Samples under;
        Samples beside;
        const vec3 normal = world.turned({0, 1, 0});
        std::mt19937 random(3);
        std::uniform_real_distribution<double> unit(-0.9, 0.9);
        for (int i = 0; i < 500; ++i) {
            under.add(world.placed({4e4 + unit(random), 0, unit(random)}), normal);
            beside.add(world.placed({4e4 + 3 + unit(random), 0, unit(random)}), normal);
        }
        const GnLight sun = sun_towards(world.turned(glm::normalize(vec3(0.1F, 1, 0.2F))));
        std::size_t counted = 0;
        EXPECT_EQ(count_dark(truth.trace(under.position_ws, under.normal_ws, sun, {}), counted), 500U)
            << degrees << " degrees, " << gap << " m";
        EXPECT_EQ(count_dark(truth.trace(beside.position_ws, beside.normal_ws, sun, {}), counted), 0U)
            << degrees << " degrees, " << gap << " m";
    }
}

TEST(Occluders, CoordinatesWithoutARoundOriginKeepTheirShadows) {
    // As a file of survey coordinates that nobody moved: units of 1/32 m, a sheet 5 cm above level ground.
    const vec3 place(412'345, 0, 534'210);
    QuadScene quads;
    quads.add(place - vec3(20, 0, 20), {0, 0, 40}, {40, 0, 0});
    quads.add(place + vec3(-2, 0.05F, -2), {0, 0, 4}, {4, 0, 0});
    const Truth truth(quads.scene);
    Samples samples;
    samples.add(place + vec3(0.5F, 0, 0.25F), {0, 1, 0});
    samples.add(place + vec3(-5, 0, 0.25F), {0, 1, 0});
    EXPECT_EQ(truth.trace(samples.position_ws, samples.normal_ws, sun_towards({0.1F, 1, 0}), {}).visibility,
              (std::vector<float>{0, 1}));
}

TEST(Occluders, AWideGroundDoesNotReachThroughWhatStandsOnIt) {
    // Samples on a small block, some of it a millimetre above the ground's plane; every direction of the sky is free.
    QuadScene quads;
    quads.add({-5e4F, 0, -5e4F}, {0, 0, 1e5F}, {1e5F, 0, 0});
    quads.add({100.25F, 1e-3F, 7}, {0, 0, 0.5F}, {0.5F, 0, 0});
    const Truth truth(quads.scene);
    const auto on_block = [&](std::size_t index) { return quads.scene.triangles[2 + index]; };
    for (const float degrees : {0.1F, 1.0F, 10.0F, 60.0F}) {
        Samples samples;
        for (std::size_t i = 0; i < 400; ++i) {
            const float u = static_cast<float>(i % 20) / 20;
            const float v = (1 - u) * static_cast<float>(i / 20) / 20;
            samples.add(interpolate(quads.scene, on_block(i % 2), {u, v}), {0, 1, 0});
        }
        std::size_t counted = 0;
        const float angle = glm::radians(degrees);
        EXPECT_EQ(count_dark(truth.trace(samples.position_ws, samples.normal_ws,
                                         sun_towards({std::cos(angle), std::sin(angle), 0.1F}), {}),
                             counted),
                  0U)
            << degrees;
        EXPECT_EQ(counted, 400U);
    }
}

TEST(Occluders, AWallOnAWideGroundShadesUpToItsFoot) {
    QuadScene quads;
    quads.add({-5e4F, 0, -5e4F}, {0, 0, 1e5F}, {1e5F, 0, 0});
    quads.add({4e4F, 0, -10}, {0, 0, 20}, {0, 3, 0});
    const Truth truth(quads.scene);
    Samples samples;
    for (const float x : {-1.0F, -0.1F, -0.0078125F, 0.0078125F, 0.1F, 1.0F}) {
        samples.add({4e4F + x, 0, 0.125F}, {0, 1, 0});
    }
    const TruthResult result = truth.trace(samples.position_ws, samples.normal_ws, sun_towards({1, 1, 0}), {});
    EXPECT_EQ(result.visibility, (std::vector<float>{0, 0, 0, 1, 1, 1}));
}

TEST(Occluders, TwoSheetsOfOnePlaneDoNotShadowEachOther) {
    // Coplanar but for rounding, and cut differently: a decal on a turned plane, far from zero.
    for (const double degrees : {0.0, 17.0, 63.0}) {
        for (const double away : {0.0, 30.0, 4e4}) {
            WideWorld world(1, degrees);
            world.quads = {};
            world.add({away - 5, 0, -5}, {0, 0, 10}, {10, 0, 0});
            world.add({away - 2, 0, -3}, {1, 0, 4}, {3, 0, 1});
            world.add({away - 1, 0, -4.5}, {-1.3, 0, 5.1}, {2.7, 0, 3.3});
            const vec3 normal = world.turned({0, 1, 0});
            const Samples samples = random_samples(world.quads.scene, normal, 2000, 9);
            std::size_t counted = 0;
            EXPECT_EQ(count_dark(Truth(world.quads.scene)
                                     .trace(samples.position_ws, samples.normal_ws,
                                            sun_towards(world.turned({1, 0.3F, 0.2F})), {}),
                                 counted),
                      0U)
                << degrees << " degrees, " << away << " m";
        }
    }
}

TEST(Occluders, ABowlOfFacetsIsLitThroughItsOpening) {
    // Facets meet at hollow edges. Samples lie on the very edges, where rounding puts half of them behind the neighbour.
    Scene scene;
    scene.materials.emplace_back();
    constexpr uint rings = 20;
    constexpr uint sides = 64;
    const vec3 centre(31, 4, -57);
    for (uint r = 0; r <= rings; ++r) {
        for (uint s = 0; s < sides; ++s) {
            const float theta = 0.5F * pi * (0.02F + 0.9F * static_cast<float>(r) / rings);
            const float phi = 2 * pi * static_cast<float>(s) / sides;
            scene.positions_ws.push_back(
                centre + vec3(std::sin(theta) * std::cos(phi), -std::cos(theta), std::sin(theta) * std::sin(phi)));
        }
    }
    for (uint r = 0; r < rings; ++r) {
        for (uint s = 0; s < sides; ++s) {
            const uint a = r * sides + s;
            const uint b = r * sides + (s + 1) % sides;
            scene.triangles.insert(scene.triangles.end(), {{a, b, b + sides}, {a, b + sides, a + sides}});
        }
    }
    scene.objects.push_back({"", 0, static_cast<uint>(scene.triangles.size()), 0, {}});
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    Samples samples;
    for (int i = 0; i < 20000; ++i) {
        const uvec3 t = scene.triangles[random() % scene.triangles.size()];
        const vec3 n = glm::cross(scene.positions_ws[t.y] - scene.positions_ws[t.x],
                                  scene.positions_ws[t.z] - scene.positions_ws[t.x]);
        const vec3 p = interpolate(scene, t, {unit(random), i % 2 == 0 ? 0.0F : 1e-6F});
        samples.add(p, glm::normalize(glm::dot(n, centre - p) > 0 ? n : -n));
    }
    std::size_t counted = 0;
    EXPECT_EQ(
        count_dark(Truth(scene).trace(samples.position_ws, samples.normal_ws, sun_towards({0, 1, 0}), {}), counted),
        0U);
    EXPECT_EQ(counted, 20000U);
}

TEST(Occluders, AWideBlockDoesNotShadowItsOwnEdge) {
    // Samples on top, millimetres from an edge of 100 km; the sun grazes the top, the wall hangs straight down.
    QuadScene quads;
    quads.add({-1e5F, 2, -5e4F}, {0, 0, 1e5F}, {1e5F, 0, 0});
    quads.add({0, -9, -5e4F}, {0, 0, 1e5F}, {0, 11, 0});
    const Truth truth(quads.scene);
    Samples samples;
    for (int i = 1; i < 500; ++i) {
        samples.add({-1e-4F * static_cast<float>(i), 2, 0.37F * static_cast<float>(i)}, {0, 1, 0});
    }
    std::size_t counted = 0;
    EXPECT_EQ(
        count_dark(truth.trace(samples.position_ws, samples.normal_ws, sun_towards({1, 0.01F, 0.3F}), {}), counted),
        0U);
    EXPECT_EQ(counted, 499U);
}

TEST(Occluders, ALampJustAboveItsFloorFarFromZero) {
    QuadScene quads;
    const vec3 place(3000, 0, -2000);
    quads.add(place - vec3(2, 0, 2), {0, 0, 4}, {4, 0, 0});
    quads.add(place + vec3(0.125F, 0, -1), {0, 0, 2}, {0, 0.5F, 0});
    GnLight lamp;
    lamp.kind = GN_LIGHT_POINT;
    lamp.position_ws = vec4(place + vec3(0, 1e-3F, 0), 1);
    Samples samples;
    for (const float x : {-0.25F, -0.0625F, 0.0625F, 0.25F}) {
        samples.add(place + vec3(x, 0, 0), {0, 1, 0});
    }
    EXPECT_EQ(Truth(quads.scene).trace(samples.position_ws, samples.normal_ws, lamp, {}).visibility,
              (std::vector<float>{1, 1, 1, 0}));
}

TEST(Occluders, AWideBlockIsLitToItsRimHoweverHighItsWall) {
    // As above, up to 10 cm from the edge, with walls on which rounding is larger than the ray is above them at the edge.
    for (const float wall : {11.0F, 1000.0F, 1e5F}) {
        for (const float elevation : {0.002F, 0.01F}) {
            for (const float aside : {0.0F, 0.3F}) {
                QuadScene quads;
                quads.add({-1e5F, 2, -5e4F}, {0, 0, 1e5F}, {1e5F, 0, 0});
                quads.add({0, 2 - wall, -5e4F}, {0, 0, 1e5F}, {0, wall, 0});
                Samples samples;
                for (int i = 1; i < 1000; ++i) {
                    samples.add({-1e-4F * static_cast<float>(i), 2, 37 * static_cast<float>(i)}, {0, 1, 0});
                }
                std::size_t counted = 0;
                EXPECT_EQ(count_dark(Truth(quads.scene)
                                         .trace(samples.position_ws, samples.normal_ws,
                                                sun_towards({1, elevation, aside}), {}),
                                     counted),
                          0U)
                    << "wall of " << wall << " m, sun " << elevation << ", aside " << aside;
                EXPECT_EQ(counted, 999U);
            }
        }
    }
}

/// A sheet of 2 m, `gap` before a lamp 3 m above the floor, all of it turned and moved; and samples of the floor.
struct LampBehindSheet {
    QuadScene quads;
    Samples samples;
    GnLight lamp;
    LampBehindSheet(double gap, double degrees, dvec3 place) {
        const dmat4 turn = glm::translate(dmat4(1.0), place) *
                           glm::rotate(dmat4(1.0), glm::radians(degrees), glm::normalize(dvec3(1, 0.2, 0.3)));
        const auto placed = [&](dvec3 p) { return vec3(turn * dvec4(p, 1.0)); };
        const auto turned = [&](dvec3 d) { return vec3(turn * dvec4(d, 0.0)); };
        for (const auto& [height, side] : {std::pair{0.0, 40.0}, {3 - gap, 2.0}}) {
            quads.add({}, {}, {});
            for (std::size_t i = 0; const dvec2 uv : {dvec2(0, 0), dvec2(0, 1), dvec2(1, 1), dvec2(1, 0)}) {
                quads.scene.positions_ws[quads.scene.positions_ws.size() - 4 + i++] =
                    placed({side * (uv.x - 0.5), height, side * (uv.y - 0.5)});
            }
        }
        for (int i = 0; i < 200; ++i) {
            const double angle = 2.4 * i;
            samples.add(placed({0.03 * i * std::cos(angle), 0, 0.03 * i * std::sin(angle)}), turned({0, 1, 0}));
        }
        lamp.kind = GN_LIGHT_RECTANGLE;
        lamp.position_ws = vec4(placed({0, 3, 0}), 1);
        lamp.direction_ws = vec4(turned({0, -1, 0}), 0);
        lamp.right_ws = vec4(turned({1, 0, 0}), 0);
        lamp.up_ws = vec4(turned({0, 0, 1}), 0);
    }
    [[nodiscard]] std::size_t dark() const {
        std::size_t counted = 0;
        const std::size_t found = count_dark(
            Truth(quads.scene).trace(samples.position_ws, samples.normal_ws, lamp, {.samples = 16}), counted);
        EXPECT_EQ(counted, samples.position_ws.size());
        return found;
    }
};

TEST(Occluders, ASheetAHairBeforeALampHidesIt) {
    // Four units of the coordinates along the gap are 1.4 micrometres of 3 m, where floats are 0.24 apart.
    EXPECT_EQ(LampBehindSheet(8 * 0x1p-22, 0, {0, 0, 0}).dark(), 200U);
    EXPECT_EQ(LampBehindSheet(8e-6, 25, {0, 0, 0}).dark(), 200U);
    EXPECT_EQ(LampBehindSheet(4e-3, 25, {3000, -40, 2000}).dark(), 200U);
}

TEST(Occluders, APanelInTheLampsOwnPlaneDoesNotHideIt) {
    for (const float half : {0.0F, 0.5F}) {
        for (const double degrees : {0.0, 25.0, 70.0}) {
            for (const dvec3 place : {dvec3(0), dvec3(30, 5, -11), dvec3(3000, -40, 2000)}) {
                for (const double gap : {0.0, -1e-3}) {
                    LampBehindSheet scene(gap, degrees, place);
                    scene.lamp.half_size = vec2(half);
                    EXPECT_EQ(scene.dark(), 0U) << half << " " << degrees << " " << place.x << " " << gap;
                }
            }
        }
    }
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
}  // namespace gn::occluders_test
