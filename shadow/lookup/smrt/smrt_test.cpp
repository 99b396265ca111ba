// SPDX-License-Identifier: MIT
// Rays hide as much of the light as its closed form says, whatever the map's resolution, placement and kind of light.
#include "shadow/lookup/smrt/smrt.glsl"

#include "shadow/recipe/part.h"
#include "tests/lookup_by_hand.h"
#include "tests/penumbra.h"
#include "tests/rescaled.h"

#include <cmath>

namespace gn::smrt_test {
namespace {

/// A ray from a tilted plane to a point of the light, against its definition: where it is, what of the plane lies on the centre's
/// ray there, and how far apart they are.
TEST(Smrt, HeightsAreThoseAlongTheCentresRays) {
    const dvec3 p_ws(0.3, -0.2, 0.5), n_ws = glm::normalize(dvec3(0.2, 1, -0.3));
    GnLight lamp;
    lamp.kind = GN_LIGHT_RECTANGLE;
    lamp.position_ws = vec4(1, 4, -0.5F, 1);
    const dvec3 centre_ws(lamp.position_ws), x_ws(0.7, 0, 0.4);
    const auto rise = 1 + glm::dot(glsl::gn_smrt_per(lamp, vec3(p_ws), vec3(n_ws)), vec3(x_ws));
    for (const double along : {0.1, 0.4, 0.8}) {
        const dvec3 seen_ws = p_ws + along * (centre_ws + x_ws - p_ws);
        // How far behind it, seen from the light, the plane lies.
        const dvec3 beyond_ws = seen_ws - centre_ws;
        const double plane = glm::dot(n_ws, p_ws - centre_ws) / glm::dot(n_ws, beyond_ws);
        const float spread = static_cast<float>(along / (1 - along));
        EXPECT_NEAR(glsl::gn_smrt_lift(false, spread, rise), 1 - 1 / plane, 1e-5) << along;
        EXPECT_NEAR(glsl::gn_smrt_spread(false, static_cast<float>(1 - 1 / plane), rise), spread, 2e-4 * spread);
    }

    GnLight sun;
    sun.kind = GN_LIGHT_DIRECTIONAL;
    const dvec3 to_light_ws = glm::normalize(dvec3(0.5, 1, 0.2)), aside_ws(0.1, -0.04, -0.05);
    sun.direction_ws = vec4(vec3(-to_light_ws), 0);
    const auto sun_rise = 1 + glm::dot(glsl::gn_smrt_per(sun, vec3(p_ws), vec3(n_ws)), vec3(aside_ws));
    const dvec3 seen_ws = p_ws + 3.0 * (to_light_ws + aside_ws);
    const double height = glm::dot(n_ws, seen_ws - p_ws) / glm::dot(n_ws, to_light_ws);
    EXPECT_NEAR(glsl::gn_smrt_lift(true, 3, sun_rise), height, 1e-5);
    EXPECT_NEAR(glsl::gn_smrt_spread(true, static_cast<float>(height), sun_rise), 3, 1e-5);
}

/// A sphere's rays fill its cone: a disc of r D / sqrt(D^2 - r^2) through its centre.
TEST(Smrt, ASphereIsTheDiscThatFillsItsCone) {
    GnLight light;
    light.kind = GN_LIGHT_POINT;
    light.radius = 0.5F;
    light.position_ws = vec4(0, 2, 0, 1);
    const glsl::GnExtentLight half_light = glsl::gn_smrt_light(light, vec3(0));
    EXPECT_NEAR(glm::length(half_light.right_ws), 0.5 * 2 / std::sqrt(4 - 0.25), 1e-5);
}

TEST(Smrt, StepsEndAtTheRaysEndAndLeaveNoneOut) {
    for (const float jitter : {0.01F, 0.5F, 1.0F}) {
        EXPECT_EQ(glsl::gn_smrt_step(1, 1, jitter), 1);
        float before = 0;
        for (int i = 1; i <= 8; ++i) {
            const float at = glsl::gn_smrt_step(i, 8, jitter);
            EXPECT_GT(at, before);
            EXPECT_LE(at - before, 1 / 7.0F + 1e-6F);
            before = at;
        }
        EXPECT_EQ(before, 1);
    }
}

/// V against the scene's closed form, and what the squares of the rays' noise would sum to at most, were they strewn at random.
void expect_closed_form(const std::string& scene, const std::string& recipe, int resolution) {
    constexpr int rays = 16;
    const auto c = test::compare(scene, fmt::format("{},resolution={}", recipe, resolution),
                                 {.width = 96, .height = 72, .samples = 256});
    double sum = 0, squares = 0, noise = 0;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        if (c.truth.counted[i] == 0) {
            continue;
        }
        // A sun's penumbra has no closed form: 256 rays of the truth stand for it.
        const double exact = c.scene.closed_form(0, dvec3(c.frame.samples.position_ws[i]))
                                 .value_or(static_cast<double>(c.truth.visibility[i]));
        const double wrong = static_cast<double>(c.visibility().values[i]) - exact;
        if (exact > 0 && exact < 1) {
            ++inside;
            sum += wrong;
            squares += wrong * wrong;
            noise += exact * (1 - exact) / rays;
        }
    }
    ASSERT_GT(inside, 200U) << scene;
    const auto count = static_cast<double>(inside);
    // The map decides an edge to its texel, as seen on the receiver behind it: views are at most 24 m wide there, ramps at least
    // 0.5 m. Slopes go half of that to both sides.
    const double texel = 24.0 / resolution / 2 / 0.5;
    EXPECT_NEAR(sum / count, 0, 0.5 * texel + 3 * std::sqrt(noise) / count)
        << scene << " by " << recipe << " at " << resolution;
    EXPECT_LT(std::sqrt(squares / count), std::sqrt(noise / count) + texel)
        << scene << " by " << recipe << " at " << resolution;
}

TEST(SmrtRendered, HalfPlaneAndSlabAreTheirClosedFormsWithinTheNoiseOfTheRays) {
    for (const char* shape : {"half-plane", "slab"}) {
        for (const char* kind : {"", ":light=spot,radius=0.4", ":light=directional"}) {
            expect_closed_form(std::string(shape) + kind, "smrt,smrt.least=0", 1024);
        }
        expect_closed_form(shape, "smrt,smrt.least=0,smrt.gaps=open,smrt.noise=pixel", 512);
    }
}

/// A light without size is its centre: the one ray reads the one texel that `hard` compares with.
TEST(SmrtRendered, WithoutSizeItIsHardToTheBit) {
    for (const char* kind : {"rectangle", "spot", "point", "directional"}) {
        Scene scene = test::lit_scene(kind);
        GnLight& light = scene.lights.front().shape;
        light.radius = light.angular_radius = 0;
        light.half_size = vec2(0);
        const auto v = [&](const char* lookup) {
            return test::visibility_of(scene, load_recipe(fmt::format("pcss,lookup={},resolution=256", lookup)), 96);
        };
        const std::vector<float> hard = v("hard");
        EXPECT_GT(std::count(hard.begin(), hard.end(), 0.0F), 50) << kind;
        EXPECT_EQ(v("smrt"), hard) << kind;
    }
}

/// Whether a placement serves the scene's first light with the recipe.
bool serves(const Part& placement, const std::string& scene_name, const std::string& recipe) {
    const Scene scene = load_scene(scene_name);
    return placement.stage == Stage::placement && placement.lights.has(scene.lights.front().shape.kind) &&
           (placement.refuses == nullptr ||
            placement.refuses(scene, scene.lights.front(), load_recipe(recipe)).empty());
}

/// Rays go on where another view serves them: every placement of a lamp's six faces, and of a sun.
TEST(SmrtRendered, RampsAreAsWideUnderEveryPlacement) {
    for (const char* kind : {"point", "directional"}) {
        for (const Part* part : all_parts()) {
            if (part->stage != Stage::placement ||
                !serves(*part, fmt::format("half-plane:light={}", kind), fmt::format("smrt,placement={}", part->id))) {
                continue;
            }
            const auto c = test::compare(fmt::format("half-plane:light={}", kind),
                                         fmt::format("smrt,resolution=512,placement={}", part->id),
                                         {.width = 64, .height = 48, .samples = 64});
            // Even points err by less than 2 / 16 on a straight edge, and 64 of the truth by half the root of V (1 - V) / 64; a
            // texel as above.
            const double texel = 24.0 / 512 / 2 / 0.5;
            EXPECT_LT(*c.errors.penumbra, 2.0 / 16 + 0.5 * std::sqrt(0.25 / 64)) << kind << " by " << part->id;
            const vec2 halves = test::error_halves(c);
            EXPECT_NEAR(halves.x, 0, texel) << kind << " by " << part->id;
            EXPECT_NEAR(halves.y, 0, texel) << kind << " by " << part->id;
        }
    }
}

/// Two sheets, one over the other, are no plane: rays pass between them where a kernel of one width does not.
TEST(SmrtRendered, CastersThatOverlapKeepTheirOwnPenumbrae) {
    const test::ComparisonOptions size{.width = 96, .height = 96, .samples = 64};
    const auto rays =
        test::compare("overlap:arrangement=opposite", "smrt,resolution=512,smrt.rays=64,smrt.noise=pixel", size);
    const auto plane =
        test::compare("overlap:arrangement=opposite", "pcss,resolution=512,pcss.taps=64,pcss.search_taps=64", size);
    EXPECT_LT(*rays.errors.penumbra, 0.8 * *plane.errors.penumbra);
}

/// Where one sheet lies behind the other, what the nearer one covers is taken for there, and leaks less.
TEST(SmrtRendered, WhatIsCoveredGoesOn) {
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 64};
    const auto open = test::compare("overlap", "smrt,resolution=512,smrt.gaps=open", size);
    const auto extended = test::compare("overlap", "smrt,resolution=512", size);
    EXPECT_LT(*extended.errors.leak, 0.96 * *open.errors.leak);
}

}  // namespace
}  // namespace gn::smrt_test
