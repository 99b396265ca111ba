// SPDX-License-Identifier: MIT
#include "shadow/lookup/filtered/filtered.glsl"

#include "shadow/geometry/convex_body.h"
#include "shadow/placement/light_views.h"

#include <gtest/gtest.h>

namespace gn::filtered_test {
namespace {

TEST(Filtered, PixelFootprintIsThePixelsShareOfTheMap) {
    // A sun straight down over 20 m x 20 m: a pixel that covers 0.1 m by 0.2 m covers that share of the map.
    GnLight sun;
    sun.direction_ws = vec4(0, -1, 0, 0);
    const GnLightView view = fit_orthographic(body_of(Box{vec3(-10, 0, -10), vec3(10, 1, 10)}), sun, 1024, {});
    glsl::GnReceiver receiver{};
    receiver.p_ws = vec3(1, 0.5F, 2);
    receiver.n_ws = vec3(0, 1, 0);
    receiver.ddx_ws = vec3(0.1F, 0, 0);
    receiver.ddy_ws = vec3(0, 0, 0.2F);
    const auto projected = glsl::gn_project(receiver, view, GnBias{});
    const auto footprint = glsl::gn_filtered_footprint(receiver, projected, GnFilteredParams{});
    EXPECT_NEAR(glm::length(footprint.ddx_ts), 0.1 / 20, 1e-5);
    EXPECT_NEAR(glm::length(footprint.ddy_ts), 0.2 / 20, 1e-5);

    // Each axis is the way to where the next pixel's receiver lies in the map.
    glsl::GnReceiver beside = receiver;
    beside.p_ws += receiver.ddx_ws;
    const vec2 step_ts = glsl::gn_project(beside, view, GnBias{}).uv_ts - projected.uv_ts;
    EXPECT_LT(glm::length(step_ts - footprint.ddx_ts), 1e-6F);

    // A radius in metres gives the same side whatever the pixel.
    GnFilteredParams world{.footprint = GN_FILTERED_WORLD, .radius_world = 0.5F};
    EXPECT_NEAR(glm::length(glsl::gn_filtered_footprint(receiver, projected, world).ddx_ts), 1.0 / 20, 1e-5);
    GnFilteredParams texels{.footprint = GN_FILTERED_RADIUS, .radius = 3};
    EXPECT_NEAR(glm::length(glsl::gn_filtered_footprint(receiver, projected, texels).ddy_ts), 6.0 / 1024, 1e-6);
}

}  // namespace
}  // namespace gn::filtered_test
