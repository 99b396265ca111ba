// SPDX-License-Identifier: MIT
// Each bias obeys its law, on the CPU from the very source that shaders include; the default needs no tuning: no acne up
// to 85 degrees, no gap wider than 1.5 texels.
#include "scenes/analytic.h"
#include "shadow/placement/light_views.h"
#include "shadow/receiver/receiver.glsl"
#include "shadow/receiver/sample_pass.h"
#include "tests/warp_scene.h"

namespace gn::bias_test {
namespace {

constexpr GnBias no_bias{.constant = 0, .slope = 0, .normal = 0, .receiver_plane = 0, .cone = 0};

GnLightView spot_view() {
    return square_perspective(vec3(0, 30, 0), vec3(0, -1, 0), vec3(0, 0, 1), 1.0, 0.01, 40, 1024);
}

/// A receiver `distance` metres below the eye of spot_view, tilted by an angle to the light, seen from the side.
glsl::GnReceiver receiver_below(float distance, float degrees = 0) {
    const float a = glm::radians(degrees);
    glsl::GnReceiver receiver{};
    receiver.p_ws = vec3(0, 30 - distance, 0);
    receiver.n_ws = vec3(std::sin(a), std::cos(a), 0);
    receiver.to_camera_ws = vec3(0, 0, 1);
    return receiver;
}

/// How far a bias moves a receiver.
vec3 shift(const glsl::GnReceiver& receiver, const GnBias& bias) {
    const GnLightView view = spot_view();
    const float texel_ws = glsl::gn_project(receiver, view, no_bias).texel_ws;
    return glsl::gn_biased(receiver, glsl::gn_to_eye(view, receiver.p_ws), texel_ws, bias) - receiver.p_ws;
}

GnBias only(float GnBias::*parameter, float value) {
    GnBias bias = no_bias;
    bias.*parameter = value;
    return bias;
}

constexpr std::array in_texels{&GnBias::constant, &GnBias::slope, &GnBias::normal, &GnBias::view};
constexpr std::array in_metres{&GnBias::constant_world, &GnBias::normal_world, &GnBias::view_world};

TEST(BiasLaws, NothingMovesAtZero) {
    for (const float degrees : {0.0F, 45.0F, 80.0F}) {
        EXPECT_EQ(shift(receiver_below(10, degrees), no_bias), vec3(0));
    }
}

TEST(BiasLaws, OneIsOneTexelOrOneMetreInItsDirection) {
    for (const float degrees : {10.0F, 50.0F}) {
        const auto receiver = receiver_below(10, degrees);
        const float texel_ws = glsl::gn_project(receiver, spot_view(), no_bias).texel_ws;
        const float sine = std::sin(glm::radians(degrees));
        const vec3 up_ws(0, 1, 0);
        const auto expect_shift = [&](float GnBias::*parameter, vec3 expected_ws) {
            EXPECT_LT(glm::distance(shift(receiver, only(parameter, 1)), expected_ws), 2e-3F * glm::length(expected_ws))
                << degrees;
        };
        expect_shift(&GnBias::constant, texel_ws * up_ws);
        expect_shift(&GnBias::constant_world, up_ws);
        expect_shift(&GnBias::slope, texel_ws * std::tan(glm::radians(degrees)) * up_ws);
        expect_shift(&GnBias::normal, texel_ws * sine * receiver.n_ws);
        expect_shift(&GnBias::normal_world, sine * receiver.n_ws);
        expect_shift(&GnBias::view, texel_ws * receiver.to_camera_ws);
        expect_shift(&GnBias::view_world, receiver.to_camera_ws);
    }
}

TEST(BiasLaws, EveryShiftIsProportionalToItsParameter) {
    for (const auto& group : {std::span<float GnBias::*const>(in_texels), std::span<float GnBias::*const>(in_metres)}) {
        for (float GnBias::*parameter : group) {
            const float one = glm::length(shift(receiver_below(10, 50), only(parameter, 1)));
            const float three = glm::length(shift(receiver_below(10, 50), only(parameter, 3)));
            EXPECT_GT(one, 1e-3F);
            EXPECT_NEAR(three, 3 * one, 1e-4F * three);
        }
    }
}

TEST(BiasLaws, TexelsMeanTexelsAtEveryDistance) {
    const GnLightView view = spot_view();
    for (float GnBias::*parameter : in_texels) {
        std::vector<float> ratios;
        for (const float distance : {1.0F, 4.0F, 16.0F, 32.0F}) {
            const auto receiver = receiver_below(distance, 40);
            const float texel_ws = glsl::gn_project(receiver, view, no_bias).texel_ws;
            EXPECT_NEAR(texel_ws, 2 * distance / 1024, 1e-3F * texel_ws);
            ratios.push_back(glm::length(shift(receiver, only(parameter, 2))) / texel_ws);
        }
        for (const float ratio : ratios) {
            EXPECT_NEAR(ratio, ratios.front(), 2e-3F * ratio);
        }
    }
    for (float GnBias::*parameter : in_metres) {
        const float near = glm::length(shift(receiver_below(1, 40), only(parameter, 0.5F)));
        EXPECT_NEAR(glm::length(shift(receiver_below(32, 40), only(parameter, 0.5F))), near, 1e-5F);
    }
}

TEST(BiasLaws, SlopeFollowsTheTangentUpToItsLimit) {
    const auto texels = [](float degrees) {
        const auto receiver = receiver_below(10, degrees);
        GnBias bias = only(&GnBias::slope, 1);
        bias.slope_max = 4;
        return glm::length(shift(receiver, bias)) / glsl::gn_project(receiver, spot_view(), no_bias).texel_ws;
    };
    EXPECT_NEAR(texels(0), 0, 1e-4);
    EXPECT_NEAR(texels(45), 1, 1e-3);
    EXPECT_NEAR(texels(70), std::tan(glm::radians(70.0)), 5e-3);
    EXPECT_NEAR(texels(80), 4, 1e-2);
    EXPECT_NEAR(texels(90), 4, 1e-2);
}

TEST(BiasLaws, NormalOffsetFollowsTheSineAndTheView) {
    for (const float degrees : {0.0F, 20.0F, 60.0F, 90.0F}) {
        const auto receiver = receiver_below(10, degrees);
        const vec3 moved = shift(receiver, only(&GnBias::normal_world, 1));
        EXPECT_NEAR(glm::length(moved), std::sin(glm::radians(degrees)), 1e-3);
        EXPECT_NEAR(glm::dot(moved, receiver.n_ws), glm::length(moved), 1e-5);
        EXPECT_EQ(shift(receiver, only(&GnBias::view_world, 1)), receiver.to_camera_ws);
    }
}

TEST(BiasLaws, AConeAsSteepAsThePlaneCoversEveryTap) {
    const GnLightView view = spot_view();
    const auto receiver = receiver_below(20, 60);
    GnBias cone = no_bias;
    cone.cone = std::tan(glm::radians(60.0F)) * 1.02F;
    GnBias flat = cone;
    flat.cone = cone.cone / 2;
    GnBias plane = no_bias;
    plane.receiver_plane = 1;
    const auto projected = glsl::gn_project(receiver, view, cone);
    const auto lower = glsl::gn_project(receiver, view, flat);
    int uncovered = 0;
    for (int i = 0; i < 64; ++i) {
        const vec2 tap_ts =
            projected.uv_ts + projected.texel_ts * 0.5F * static_cast<float>(i % 8) *
                                  vec2(std::cos(static_cast<float>(i)), std::sin(static_cast<float>(i)));
        const float surface =
            glsl::gn_depth_at(projected, tap_ts, plane) + glsl::gn_cone(projected, tap_ts - projected.uv_ts);
        EXPECT_LE(glsl::gn_depth_at(projected, tap_ts, cone), surface);
        uncovered += glsl::gn_depth_at(lower, tap_ts, flat) > surface ? 1 : 0;
    }
    EXPECT_GT(uncovered, 8);

    // k texels away it takes k times as much off, in any direction; and four at once answer alike.
    const float at_receiver = glsl::gn_depth_at(projected, projected.uv_ts, cone);
    for (const float k : {1.0F, 2.0F, 6.0F}) {
        const vec2 d_ts = projected.texel_ts * k * vec2(0.6F, -0.8F);
        const float expected = k * cone.cone * projected.texel_ws / view.metres_per_depth;
        const float depth = glsl::gn_depth_at(projected, projected.uv_ts + d_ts, cone);
        EXPECT_NEAR(at_receiver - depth, expected, 1e-3F * expected + 2e-7F);
        const auto lit = [&](float occluder) {
            return glsl::gn_lit_beside(projected, vec4(d_ts.x), vec4(d_ts.y), vec4(occluder), cone).z;
        };
        EXPECT_TRUE(lit(depth + 1e-3F * expected + 2e-7F));
        EXPECT_FALSE(lit(depth - 1e-3F * expected - 2e-7F));
    }
}

TEST(BiasLaws, WithThePlaneTheConeOpensToWhereThePlaneFallsAway) {
    // A plane that turns away from the light along +x: there k texels take k times the cone off, elsewhere nothing.
    const GnLightView view = spot_view();
    GnBias plane = no_bias;
    plane.receiver_plane = 1;
    GnBias cone = plane;
    cone.cone = 2;
    for (const float degrees : {2.0F, 20.0F, 60.0F}) {
        const auto receiver = receiver_below(20, degrees);
        const auto open = glsl::gn_project(receiver, view, cone);
        const auto without = glsl::gn_project(receiver, view, plane);
        // n = (sin, cos): the plane falls towards +x. Fully open from a tangent of 1/4, in proportion below.
        const vec2 fall_ts = open.texel_ts * glm::normalize(vec2(open.du_ws.x, open.dv_ws.x));
        const float opened = std::min(1.0F, 4 * std::tan(glm::radians(degrees)));
        const float expected = opened * 2 * open.texel_ws / view.metres_per_depth;
        const auto taken = [&](vec2 d_ts) {
            const vec2 tap_ts = open.uv_ts + d_ts;
            const float here = glsl::gn_depth_at(without, tap_ts, plane) - glsl::gn_depth_at(open, tap_ts, cone);
            const vec4 occluder(glsl::gn_depth_at(without, tap_ts, plane) - 0.5F * (here + 1e-5F));
            EXPECT_EQ(glsl::gn_lit_at(open, vec4(tap_ts.x), vec4(tap_ts.y), occluder, cone).x, here > 1e-5F);
            return here;
        };
        EXPECT_NEAR(taken(fall_ts), expected, 0.02F * expected + 3e-7F) << degrees;
        EXPECT_NEAR(taken(3.0F * fall_ts), 3 * expected, 0.02F * 3 * expected + 3e-7F) << degrees;
        EXPECT_NEAR(taken(-fall_ts), 0, 3e-7F) << degrees;
        EXPECT_NEAR(taken(vec2(-fall_ts.y, fall_ts.x)), 0, 0.02F * expected) << degrees;
    }
}

TEST(BiasLaws, AFootprintOfThePixelReachesHalfOfItAcrossTheRays) {
    glsl::GnReceiver receiver{};
    receiver.ddx_ws = vec3(0.2F, 0, 0);
    receiver.ddy_ws = vec3(0, 0, -0.4F);
    GnBias bias = no_bias;
    EXPECT_EQ(glsl::gn_pixel_reach(receiver, vec3(0, 1, 0), bias), 0);
    bias.reach_pixels = 1;
    EXPECT_NEAR(glsl::gn_pixel_reach(receiver, vec3(0, 1, 0), bias), 0.3, 1e-6);
    // Along the rays nothing is covered.
    EXPECT_NEAR(glsl::gn_pixel_reach(receiver, vec3(1, 0, 0), bias), 0.2, 1e-6);
}

TEST(BiasLaws, TexelsGrowWithTheKernelUnlessThePlaneIsFollowed) {
    const float texel_ws = 0.02F;
    GnBias bias = no_bias;
    EXPECT_EQ(glsl::gn_bias_growth(bias, texel_ws, 0), 1);
    bias.reach = 2.5F;
    EXPECT_EQ(glsl::gn_bias_growth(bias, texel_ws, 0), 6);
    bias.reach_world = 0.1F;
    EXPECT_NEAR(glsl::gn_bias_growth(bias, texel_ws, 0), 11, 1e-4);
    EXPECT_NEAR(glsl::gn_bias_growth(bias, texel_ws, 0.06F), 17, 1e-4);
    bias.kernel = 0;
    EXPECT_EQ(glsl::gn_bias_growth(bias, texel_ws, 0), 1);
    bias.kernel = 1;
    bias.receiver_plane = 1;
    EXPECT_EQ(glsl::gn_bias_growth(bias, texel_ws, 0), 1);
}

TEST(BiasLaws, ReachIsTheKernelsHalfWidth) {
    EXPECT_EQ(applied_bias(load_recipe("hard"), {}, {}).reach, 0);
    EXPECT_EQ(applied_bias(load_recipe("pcf,pcf.kernel=nxn,pcf.size=7"), {}, {}).reach, 4);
    EXPECT_EQ(applied_bias(load_recipe("pcf,pcf.kernel=vogel,pcf.radius=6"), {}, {}).reach, 6);
    EXPECT_NEAR(applied_bias(load_recipe("pcf,pcf.kernel=vogel,pcf.radius_world=0.3"), {}, {}).reach_world, 0.3F, 1e-6);
}

TEST(BiasRendered, SlopeCoversAWideKernelOnlyWhereItGrowsWithIt) {
    const std::string recipe =
        "pcf,pcf.size=7,resolution=512,bias.receiver_plane=0,bias.cone=0,bias.normal=0,bias.constant=0.5,bias.slope=1";
    const auto grown = test::compare("tilted:angle=70", recipe);
    const auto fixed = test::compare("tilted:angle=70", recipe + ",bias.kernel=0");
    EXPECT_LE(*grown.errors.acne, 1e-3);
    EXPECT_GT(*fixed.errors.acne, 0.05);
}

TEST(BiasRendered, EachBiasAloneClearsAPlaneThatItsParameterCovers) {
    // Half a texel's diagonal at 60 degrees is 1.23 texels deep; the kernel of 3 reaches 2 texels further.
    const std::string bare = ",resolution=512,bias.receiver_plane=0,bias.cone=0,bias.normal=0,bias.constant=0";
    EXPECT_GT(*test::compare("tilted:angle=60", "hard" + bare).errors.acne, 0.3);
    for (const char* cure : {"constant=1.3", "slope=0.75", "normal=1.5", "constant_world=0.5"}) {
        EXPECT_LE(*test::compare("tilted:angle=60", "hard" + bare + ",bias." + cure).errors.acne, 1e-3) << cure;
        const std::string first = std::string(cure).substr(0, std::string(cure).find('='));
        EXPECT_GT(*test::compare("tilted:angle=60", fmt::format("hard{},bias.{}=0.001", bare, first)).errors.acne, 0.1)
            << first;
    }
    EXPECT_GT(*test::compare("tilted:angle=60", "pcf" + bare).errors.acne, 0.2);
    EXPECT_LE(*test::compare("tilted:angle=60", "pcf" + bare + ",bias.cone=2").errors.acne, 1e-3);
}

TEST(DefaultBias, LeavesTiltedPlanesWithoutAcneTo85Degrees) {
    for (const int angle : {0, 15, 30, 45, 60, 70, 80, 85}) {
        for (const char* recipe : {"hard", "pcf"}) {
            const auto c =
                test::compare(fmt::format("tilted:angle={}", angle), fmt::format("{},resolution=1024", recipe));
            EXPECT_LE(*c.errors.acne, 1e-3) << recipe << " at " << angle << " degrees";
        }
    }
}

TEST(DefaultBias, MovesWhatFacesTheLightByHalfATexel) {
    // A plane that faces the light leaves nothing for the other biases to do: no sine for the offset along the normal, no
    // side that falls away for the cone. What bends within half a texel is cleared (docs/bias.md, creases).
    const auto receiver = receiver_below(10);
    const float half_ws = 0.5F * glsl::gn_project(receiver, spot_view(), no_bias).texel_ws;
    EXPECT_LT(glm::distance(shift(receiver, load_recipe("hard").bias), vec3(0, half_ws, 0)), 2e-3F * half_ws);
}

TEST(DefaultBias, WithoutItAcneAppears) {
    const auto c = test::compare(
        "tilted:angle=60",
        "hard,resolution=1024,bias.receiver_plane=0,bias.cone=0,bias.normal=0,bias.constant=0,bias.slope=0");
    EXPECT_GT(*c.errors.acne, 0.1);
}

/// The smallest texel under the box of `contact`, metres across the rays.
double texel_under_box(const Scene& scene, const std::string& recipe, const test::ComparisonOptions& options) {
    const LightViews views = test::place(scene, recipe, options.width, options.height, &scene.camera(options.view));
    double texel = 1e9;
    for (const GnLightView& view : views.views) {
        glsl::GnReceiver receiver{};
        receiver.n_ws = vec3(0, 1, 0);
        const auto projected = glsl::gn_project(receiver, view, no_bias);
        texel = projected.inside ? std::min(texel, static_cast<double>(projected.texel_ws)) : texel;
    }
    return texel;
}

/// The gap at the foot of the box, in texels.
double gap_in_texels(const std::string& scene, const std::string& recipe) {
    const test::ComparisonOptions options{.width = 320, .height = 240, .samples = 1, .view = "foot"};
    const auto c = test::compare(scene, recipe, options);
    const double gap =
        scenes::contact_scene::gap(c.scene.lights[0].shape, c.frame.samples.position_ws, c.visibility().values);
    return gap / texel_under_box(c.scene, recipe, options);
}

TEST(DefaultBias, LeavesNoGapWiderThanOneAndAHalfTexels) {
    for (const char* light : {"directional", "spot", "point"}) {
        for (const int elevation : {20, 40, 70}) {
            for (const char* recipe : {"hard,resolution=512", "pcf,resolution=512"}) {
                const double gap =
                    gap_in_texels(fmt::format("contact:light={},elevation={}", light, elevation), recipe);
                EXPECT_LE(gap, 1.5) << recipe << ", " << light << " at " << elevation << " degrees";
            }
        }
    }
}

TEST(DefaultBias, ABiasThickerThanTheBoxBringsTheGap) {
    // The light's rays leave the box by its foot after 1 / sin(40) = 1.56 m in it.
    EXPECT_LE(gap_in_texels("contact", "hard,resolution=512,bias.constant_world=0.1"), 1.5);
    EXPECT_GT(gap_in_texels("contact", "hard,resolution=512,bias.constant_world=1.6"), 10);
}

}  // namespace
}  // namespace gn::bias_test
