// SPDX-License-Identifier: MIT
#include "shadow/geometry/convex_body.h"
#include "shadow/placement/light_views.h"
#include "shadow/recipe/guard.h"

#include <gtest/gtest.h>

namespace gn::potential_receivers_test {
namespace {

double volume_of(const ConvexBody& body) {
    // Sum the pyramids between an inner point and every face.
    dvec3 centre(0);
    const auto vertices = body.vertices();
    for (const dvec3& v : vertices) {
        centre += v / static_cast<double>(vertices.size());
    }
    double volume = 0;
    for (const auto& face : body.faces_ws) {
        for (std::size_t i = 2; i < face.size(); ++i) {
            volume += std::abs(glm::dot(face[0] - centre, glm::cross(face[i - 1] - centre, face[i] - centre))) / 6;
        }
    }
    return volume;
}

TEST(ConvexBody, ClippingACubeLeavesTheRightVolume) {
    const ConvexBody cube = body_of(Box{vec3(0), vec3(1)});
    EXPECT_NEAR(volume_of(cube), 1, 1e-12);
    EXPECT_NEAR(volume_of(clip(cube, {dvec3(1, 0, 0), -0.25})), 0.75, 1e-12);
    // x + y + z <= 1 leaves the corner's tetrahedron.
    EXPECT_NEAR(volume_of(clip(cube, {dvec3(-1, -1, -1), 1.0})), 1.0 / 6, 1e-12);
    EXPECT_TRUE(clip(cube, {dvec3(1, 0, 0), -2}).empty());
    EXPECT_NEAR(volume_of(clip(cube, {dvec3(1, 0, 0), 5})), 1, 1e-12);
}

TEST(ConvexBody, FrustumHasTheRightVolume) {
    const Camera camera{.yfov = pi / 2};
    // A pyramid stump between distances 1 and 4 with half-extents 2d by d.
    const double expected = 4.0 * 2.0 * (64 - 1) / 3.0;
    EXPECT_NEAR(volume_of(body_of(camera, 2, 1, 4)), expected, 1e-5 * expected);
    ConvexBody cut = body_of(Box{vec3(-100), vec3(100)});
    for (const Plane& plane : frustum_planes(camera, 2, 1, 4)) {
        cut = clip(cut, plane);
    }
    EXPECT_NEAR(volume_of(cut), expected, 1e-5 * expected);
}

GnLight sun_towards(vec3 direction_ws) {
    GnLight light;
    light.direction_ws = vec4(glm::normalize(direction_ws), 0);
    return light;
}

vec3 row_of(const GnLightView& view, int i) {
    return {view.cs_from_ws[0][i], view.cs_from_ws[1][i], view.cs_from_ws[2][i]};
}

TEST(FitOrthographic, HullTouchesAllFourBordersAndNearAndFar) {
    ConvexBody body = body_of(Box{vec3(-3, 0, -8), vec3(5, 2, 1)});
    const Camera camera{.position_ws = vec3(0, 1, 3)};
    for (const Plane& plane : frustum_planes(camera, 1.5F, 0.1, 100)) {
        body = clip(body, plane);
    }
    const GnLightView view = fit_orthographic(body, sun_towards(vec3(1, -2, 0.5F)), 512, {});
    dvec3 low(1e9);
    dvec3 high(-1e9);
    for (const dvec3& p : body.vertices()) {
        const vec4 p_cs = view.cs_from_ws * vec4(vec3(p), 1);
        low = glm::min(low, dvec3(vec3(p_cs)));
        high = glm::max(high, dvec3(vec3(p_cs)));
        // What lookups compare is what the map is drawn with.
        EXPECT_NEAR(glm::dot(view.depth_from_ws, vec4(vec3(p), 1)), p_cs.z, 1e-6);
    }
    const double texel = 2.0 / 512;
    EXPECT_NEAR(low.x, -1, texel);
    EXPECT_NEAR(low.y, -1, texel);
    EXPECT_NEAR(high.x, 1, texel);
    EXPECT_NEAR(high.y, 1, texel);
    // The nearest point lies behind the near plane by the room for biases.
    const double side = 2.0 / static_cast<double>(std::min(glm::length(row_of(view, 0)), glm::length(row_of(view, 1))));
    EXPECT_NEAR(low.z, room_of({}) * side / 512 / static_cast<double>(view.metres_per_depth), 1e-3);
    EXPECT_NEAR(high.z, 1, 1e-3);
}

TEST(FitOrthographic, RectangleOfLeastAreaFollowsARotatedBox) {
    // A long thin box, turned by 30 degrees around the light: an axis-aligned fit would waste most of the map.
    const dmat4 turn = glm::rotate(dmat4(1), glm::radians(30.0), dvec3(0, 1, 0));
    ConvexBody body = body_of(Box{vec3(-10, 0, -0.5F), vec3(10, 1, 0.5F)});
    for (auto& face : body.faces_ws) {
        for (dvec3& p : face) {
            p = dvec3(turn * dvec4(p, 1));
        }
    }
    const GnLightView view = fit_orthographic(body, sun_towards(vec3(0, -1, 0)), 1000, {});
    const double metres_u =
        2.0 / glm::length(vec3(view.cs_from_ws[0][0], view.cs_from_ws[1][0], view.cs_from_ws[2][0]));
    const double metres_v =
        2.0 / glm::length(vec3(view.cs_from_ws[0][1], view.cs_from_ws[1][1], view.cs_from_ws[2][1]));
    EXPECT_NEAR(metres_u * metres_v, 20.0, 20 * 1e-5);  // rounding of the matrix
}

TEST(FitOrthographic, GuardLeavesRoomForTheKernel) {
    const ConvexBody body = body_of(Box{vec3(-1), vec3(1)});
    const GnLightView view = fit_orthographic(body, sun_towards(vec3(0, -1, 0)), 256, {.texels = 8});
    for (const dvec3& p : body.vertices()) {
        const vec4 p_cs = view.cs_from_ws * vec4(vec3(p), 1);
        EXPECT_LE(std::abs(p_cs.x), 1 - 2 * 8.0 / 256 + 1e-5);
        EXPECT_LE(std::abs(p_cs.y), 1 - 2 * 8.0 / 256 + 1e-5);
    }
}

TEST(FitPerspective, HullTouchesAllFourBorders) {
    GnLight light;
    light.kind = GN_LIGHT_SPOT;
    light.position_ws = vec4(0, 5, 0, 1);
    light.direction_ws = vec4(0, -1, 0, 0);
    const ConvexBody body = body_of(Box{vec3(-1, 0, -2), vec3(2, 1, 1)});
    const Fitted fitted = fit_perspective(body, light, 512, {});
    ASSERT_TRUE(fitted.valid);
    dvec2 low(1e9);
    dvec2 high(-1e9);
    for (const dvec3& p : body.vertices()) {
        const vec4 p_cs = fitted.view.cs_from_ws * vec4(vec3(p), 1);
        low = glm::min(low, dvec2(p_cs.x, p_cs.y) / static_cast<double>(p_cs.w));
        high = glm::max(high, dvec2(p_cs.x, p_cs.y) / static_cast<double>(p_cs.w));
        const float depth = glm::dot(fitted.view.depth_from_ws, vec4(vec3(p), 1));
        EXPECT_GT(depth, 0);
        EXPECT_LT(depth, 1);
    }
    EXPECT_NEAR(low.x, -1, 2.0 / 512);
    EXPECT_NEAR(low.y, -1, 2.0 / 512);
    EXPECT_NEAR(high.x, 1, 2.0 / 512);
    EXPECT_NEAR(high.y, 1, 2.0 / 512);
}

TEST(FitPerspective, RefusesABodyAroundTheLight) {
    GnLight light;
    light.kind = GN_LIGHT_RECTANGLE;
    light.position_ws = vec4(0, 0.5F, 0, 1);
    light.direction_ws = vec4(0, -1, 0, 0);
    const ConvexBody body = body_of(Box{vec3(-9, 0, -9), vec3(9, 0.4F, 9)});
    EXPECT_FALSE(fit_perspective(body, light, 512, {}).valid);
}

}  // namespace
}  // namespace gn::potential_receivers_test
