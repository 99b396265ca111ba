// SPDX-License-Identifier: MIT
// A camera that was made a matrix comes back from it.
#include "shadow/embed/lent_camera.h"

#include "base/error.h"

#include <gtest/gtest.h>

namespace gn::embed::lent_camera_test {
namespace {

const Box bounds_ws{vec3(-20), vec3(20)};

Camera some_camera() {
    return {.position_ws = {3, 2, 5},
            .forward_ws = glm::normalize(vec3(-3, -1, -5)),
            .yfov = 0.7F,
            .near = 0.25F,
            .far = 30,
            .shift_cs = vec2(0.003F, -0.002F)};
}

void expect_same(const Camera& a, const Camera& b) {
    EXPECT_LT(glm::length(a.position_ws - b.position_ws), 1e-4F);
    EXPECT_LT(glm::length(a.forward_ws - b.forward_ws), 1e-5F);
    EXPECT_NEAR(a.yfov, b.yfov, 1e-5F);
    EXPECT_NEAR(a.near, b.near, 1e-4F * b.near);
    EXPECT_NEAR(a.far, b.far, 1e-2F * b.far);
    EXPECT_LT(glm::length(a.shift_cs - b.shift_cs), 1e-5F);
    const vec3 right = glm::cross(b.forward_ws, b.up_ws);
    EXPECT_LT(std::abs(glm::dot(a.up_ws, right)), 1e-5F);
    EXPECT_GT(glm::dot(a.up_ws, b.up_ws), 0.0F);
}

/// Metres along the axis, from the clip space of a point.
double distance_of(const LentCamera& lent, const mat4& cs_from_ws, vec3 p_ws) {
    const dvec4 p_cs = dmat4(cs_from_ws) * dvec4(dvec3(p_ws), 1);
    const double depth = p_cs.z / p_cs.w;
    return is_orthographic(lent.camera) ? lent.z_offset + lent.z_scale * depth : lent.z_offset / (depth - lent.z_scale);
}

TEST(LentCamera, ComesBackFromItsMatrix) {
    const Camera camera = some_camera();
    const mat4 cs_from_ws = cs_from_vs(camera, 16.0F / 9) * vs_from_ws(camera);
    const LentCamera lent = camera_of(cs_from_ws, true, 1600, 900, bounds_ws);
    expect_same(lent.camera, camera);
    const vec3 p_ws(0.5F, -1, 1);
    EXPECT_NEAR(distance_of(lent, cs_from_ws, p_ws), glm::dot(p_ws - camera.position_ws, camera.forward_ws), 1e-4);
}

TEST(LentCamera, PlainDepthAndInfiniteRangesAreUnderstood) {
    const Camera camera = some_camera();
    const mat4 reversed = cs_from_vs(camera, 1) * vs_from_ws(camera);
    mat4 flip(1);  // depth 1 - d
    flip[2].z = -1;
    flip[3].z = 1;
    expect_same(camera_of(flip * reversed, false, 64, 64, bounds_ws).camera, camera);

    // Reversed without end: depth = near / z.
    mat4 endless = reversed;
    for (int i = 0; i < 4; ++i) {
        endless[i].z = i == 3 ? camera.near : 0.0F;
    }
    const LentCamera lent = camera_of(endless, true, 64, 64, bounds_ws);
    EXPECT_NEAR(lent.camera.near, camera.near, 1e-5F);
    EXPECT_GT(lent.camera.far, 20.0F);
    EXPECT_LT(lent.camera.far, 60.0F) << "it ends behind all that is seen";
}

TEST(LentCamera, MayBeOrthographic) {
    Camera camera = some_camera();
    camera.shift_cs = vec2(0);
    camera.half_height = 3;
    const mat4 cs_from_ws = cs_from_vs(camera, 2) * vs_from_ws(camera);
    const LentCamera lent = camera_of(cs_from_ws, true, 128, 64, bounds_ws);
    EXPECT_NEAR(lent.camera.half_height, 3, 1e-4F);
    EXPECT_LT(glm::length(lent.camera.forward_ws - camera.forward_ws), 1e-5F);
    const vec3 p_ws(0.5F, -1, 1);
    EXPECT_NEAR(distance_of(lent, cs_from_ws, p_ws), glm::dot(p_ws - lent.camera.position_ws, camera.forward_ws), 1e-3);
}

TEST(LentCamera, WhatIsNoCameraIsASentence) {
    const Camera camera = some_camera();
    const mat4 good = cs_from_vs(camera, 1) * vs_from_ws(camera);
    EXPECT_THROW(camera_of(mat4(0), true, 64, 64, bounds_ws), Error);
    EXPECT_THROW(camera_of(good, true, 128, 64, bounds_ws), Error) << "pixels twice as wide as high";
    mat4 mirrored = good;
    for (int i = 0; i < 4; ++i) {
        mirrored[i].x = -mirrored[i].x;
    }
    EXPECT_THROW(camera_of(mirrored, true, 64, 64, bounds_ws), Error);
    mat4 broken = good;
    broken[1].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(camera_of(broken, true, 64, 64, bounds_ws), Error);
}

}  // namespace
}  // namespace gn::embed::lent_camera_test
