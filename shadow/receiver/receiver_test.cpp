// SPDX-License-Identifier: MIT
// Laws of projection and bias, on the CPU from the very source that shaders include.
#include "shadow/receiver/map_access.glsl"

#include "shadow/geometry/convex_body.h"
#include "shadow/placement/light_views.h"

#include <gtest/gtest.h>

#include <random>

namespace gn::receiver_test {
namespace {

glsl::GnReceiver receiver_at(vec3 p_ws, vec3 n_ws) {
    glsl::GnReceiver r{};
    r.p_ws = p_ws;
    r.n_ws = n_ws;
    return r;
}

GnLightView spot_view() {
    return square_perspective(vec3(0, 10, 0), vec3(0, -1, 0), vec3(0, 0, 1), 1.0, 0.01, 30, 1024);
}

GnLightView sun_view() {
    GnLight sun;
    sun.direction_ws = vec4(glm::normalize(vec3(0.3F, -1.0F, 0.2F)), 0);
    return fit_orthographic(body_of(Box{vec3(-5, 0, -5), vec3(5, 4, 5)}), sun, 1024, {});
}

const GnBias no_bias{.constant = 0, .slope = 0, .normal = 0, .receiver_plane = 1, .cone = 0};

class Projection : public ::testing::TestWithParam<GnLightView> {};

TEST_P(Projection, DepthOfThePlaneIsExactUnderAnyProjection) {
    const GnLightView& view = GetParam();
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const vec3 n_ws = glm::normalize(vec3(uniform(random), 1.2F, uniform(random)));
        const vec3 p_ws(uniform(random), 1 + uniform(random), uniform(random));
        const auto projected = glsl::gn_project(receiver_at(p_ws, n_ws), view, no_bias);

        // Any other point of the plane must have the depth that the first one predicts for it.
        vec3 x;
        vec3 y;
        complete_frame(n_ws, x, y);
        const vec3 q_ws = p_ws + 0.5F * (uniform(random) * x + uniform(random) * y);
        const auto other = glsl::gn_project(receiver_at(q_ws, n_ws), view, no_bias);
        EXPECT_NEAR(glsl::gn_depth_at(projected, other.uv_ts, no_bias), other.depth, 2e-6)
            << "sample " << i << " n = (" << n_ws.x << ", " << n_ws.y << ", " << n_ws.z << ")";
    }
}

TEST_P(Projection, FourAtOnceAnswerAsOneByOne) {
    const GnLightView& view = GetParam();
    const auto projected =
        glsl::gn_project(receiver_at(vec3(0.2F, 1, 0.1F), glm::normalize(vec3(0.5F, 1, 0.2F))), view, GnBias{});
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-0.01F, 0.01F);
    int lit = 0;
    for (int i = 0; i < 100; ++i) {
        vec4 u(0);
        vec4 v(0);
        vec4 occluder(0);
        for (int k = 0; k < 4; ++k) {
            u[k] = projected.uv_ts.x + uniform(random);
            v[k] = projected.uv_ts.y + uniform(random);
            occluder[k] = glsl::gn_depth_at(projected, vec2(u[k], v[k]), GnBias{}) + 0.3F * uniform(random);
        }
        const glm::bvec4 four = glsl::gn_lit_at(projected, u, v, occluder, GnBias{});
        for (int k = 0; k < 4; ++k) {
            const float depth = glsl::gn_depth_at(projected, vec2(u[k], v[k]), GnBias{});
            if (std::abs(depth - occluder[k]) > 1e-6F) {
                EXPECT_EQ(four[k], depth <= occluder[k]);
                lit += four[k] ? 1 : 0;
            }
        }
    }
    EXPECT_GT(lit, 50);
    EXPECT_LT(lit, 350);
}

TEST_P(Projection, TexelSizeIsTheWorldLengthOfATexel) {
    const GnLightView& view = GetParam();
    const vec3 p_ws(0.3F, 1, -0.2F);
    const vec3 to_eye = glsl::gn_to_eye(view, p_ws);
    const auto projected = glsl::gn_project(receiver_at(p_ws, to_eye), view, no_bias);

    // Step across the ray by one texel along the gradient of u: u must move by one texel.
    const vec3 across = glm::normalize(projected.du_ws);
    EXPECT_NEAR(glm::dot(across, to_eye), 0, 1e-4);
    const float step = projected.texel_ts / glm::length(projected.du_ws);
    const auto moved = glsl::gn_project(receiver_at(p_ws + across * step, to_eye), view, no_bias);
    EXPECT_NEAR(moved.uv_ts.x - projected.uv_ts.x, projected.texel_ts, 2e-3F * projected.texel_ts + 2e-7F);
}

TEST_P(Projection, AViewTakesItsRectangleOfTheLayer) {
    const GnLightView& view = GetParam();
    const vec3 p_ws(0.3F, 1, -0.2F);
    const vec4 p_cs = view.cs_from_ws * vec4(p_ws, 1);
    const vec2 whole_ts = 0.5F * vec2(p_cs) / p_cs.w + 0.5F;
    const auto whole = glsl::gn_project(receiver_at(p_ws, vec3(0, 1, 0)), view, no_bias);
    EXPECT_LT(glm::length(whole.uv_ts - whole_ts), 1e-6F);

    // Half as wide and a quarter as high: texels are twice as wide and four times as high, and the larger side counts.
    GnLightView part = view;
    part.rect_ts = vec4(0.5F, 0.25F, 0.5F, 0.25F);
    const auto moved = glsl::gn_project(receiver_at(p_ws, vec3(0, 1, 0)), part, no_bias);
    EXPECT_LT(glm::length(moved.uv_ts - (vec2(0.5F, 0.25F) + whole_ts * vec2(0.5F, 0.25F))), 1e-6F);
    EXPECT_NEAR(moved.texel_ws, 4 * whole.texel_ts / glm::length(whole.dv_ws), 1e-4F * moved.texel_ws);
    EXPECT_GT(moved.texel_ws, 3 * whole.texel_ts / glm::length(whole.du_ws));
}

TEST_P(Projection, BiasMovesTowardsTheLightByTexelsAndMetres) {
    const GnLightView& view = GetParam();
    const vec3 p_ws(0.1F, 0.5F, 0.4F);
    const vec3 n_ws = glsl::gn_to_eye(view, p_ws);
    const auto plain = glsl::gn_project(receiver_at(p_ws, n_ws), view, no_bias);
    GnBias bias = no_bias;
    bias.constant = 2;
    bias.constant_world = 0.01F;
    const auto biased = glsl::gn_project(receiver_at(p_ws, n_ws), view, bias);
    const vec3 axis = glm::normalize(vec3(view.depth_from_ws));
    const float expected = (2 * plain.texel_ws + 0.01F) * std::abs(glm::dot(axis, n_ws));
    EXPECT_NEAR((plain.depth - biased.depth) * view.metres_per_depth, expected, 1e-4F);
}

TEST_P(Projection, ATapsWayStaysInThePlaneAndEndsAtTheTap) {
    const GnLightView& view = GetParam();
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int i = 0; i < 100; ++i) {
        const vec3 n_ws = glm::normalize(vec3(uniform(random), 1.2F, uniform(random)));
        const auto receiver = receiver_at(vec3(uniform(random), 1 + uniform(random), uniform(random)), n_ws);
        const vec2 d_ts(0.1F * uniform(random), 0.1F * uniform(random));
        const vec3 way_ws = glsl::gn_way_ws(receiver, view, d_ts);
        EXPECT_NEAR(glm::dot(way_ws, n_ws), 0, 1e-5);  // metres, of some
        const vec2 from_ts = glsl::gn_project(receiver, view, no_bias).uv_ts;
        const vec2 to_ts = glsl::gn_project(receiver_at(receiver.p_ws + way_ws, n_ws), view, no_bias).uv_ts;
        EXPECT_LT(glm::distance(from_ts + d_ts, to_ts), 1e-5F) << i;  // a hundredth of a texel
    }
}

INSTANTIATE_TEST_SUITE_P(Views, Projection, ::testing::Values(sun_view(), spot_view()),
                         [](const auto& view) { return view.index == 0 ? "Sun" : "Spot"; });

TEST(Projection, ReceiverBehindTheEyeIsOutside) {
    const auto projected = glsl::gn_project(receiver_at(vec3(0, 11, 0), vec3(0, 1, 0)), spot_view(), no_bias);
    EXPECT_FALSE(projected.inside);
}

}  // namespace
}  // namespace gn::receiver_test
