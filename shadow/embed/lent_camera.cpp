// SPDX-License-Identifier: MIT
#include "shadow/embed/lent_camera.h"

#include "base/error.h"

#include <cmath>

namespace gn::embed {
namespace {

constexpr const char* want =
    "it must be a perspective or orthographic camera's, in Vulkan's clip space with y downwards";

struct Rows {
    std::array<dvec4, 4> r;
    [[nodiscard]] dvec3 axis(std::size_t i) const { return dvec3(r[i]); }
};

Rows rows_of(const mat4& cs_from_ws) {
    const mat4 t = glm::transpose(cs_from_ws);
    return {{dvec4(t[0]), dvec4(t[1]), dvec4(t[2]), dvec4(t[3])}};
}

/// The point at which three planes meet.
dvec3 meet(const dvec4& a, const dvec4& b, const dvec4& c) {
    const glm::dmat3 rows = glm::transpose(glm::dmat3(dvec3(a), dvec3(b), dvec3(c)));
    return glm::inverse(rows) * -dvec3(a.w, b.w, c.w);
}

/// Fills in axes, angle or height, and shift, from the rows of x and y; `forward` is unit, `seen` the part of a row that
/// shifts the picture.
void set_axes(Camera& camera, dvec3 x, dvec3 y, dvec3 forward, uint width, uint height) {
    const double across = glm::length(x), down = glm::length(y);
    if (!(across > 0 && down > 0)) {
        fail("the camera's matrix has an axis without length; {}", want);
    }
    const double pixels = across * width / (down * height);
    if (std::abs(pixels - 1) > 0.01) {
        fail("the camera's pixels are {:.3f} times as wide as high for a picture of {} x {}; they must be square",
             1 / pixels, width, height);
    }
    const dvec3 up = -y / down;
    if (glm::dot(glm::cross(forward, up), x / across) < 0.99) {
        fail("the camera's matrix mirrors or shears the picture; {}", want);
    }
    camera.forward_ws = vec3(forward);
    camera.up_ws = vec3(up);
}

double farthest_along(const Box& bounds_ws, dvec3 eye, dvec3 forward) {
    double z = 0;
    for (const vec3 corner : bounds_ws.corners()) {
        z = std::max(z, glm::dot(dvec3(corner) - eye, forward));
    }
    return z;
}

/// depth = z_scale + z_offset / z between near and far, which may be infinite.
void set_range(LentCamera& lent, bool reversed, double end) {
    const double at_near = reversed ? 1 : 0;
    const double near = lent.z_offset / (at_near - lent.z_scale);
    const double far = lent.z_offset / (1 - at_near - lent.z_scale);
    if (!(near > 0) || !std::isfinite(near)) {
        fail("the camera's matrix has no near plane before the eye for {} depth", reversed ? "reversed" : "plain");
    }
    lent.camera.near = static_cast<float>(near);
    const double last = std::max(end * 1.01, near * 2);
    lent.camera.far = static_cast<float>(far > near && far < last ? far : last);
}

LentCamera perspective(Rows m, bool reversed, uint width, uint height, const Box& bounds_ws) {
    const double scale = glm::length(m.axis(3));
    for (dvec4& row : m.r) {
        row /= scale;
    }
    const dvec3 forward = m.axis(3);
    const dvec3 eye = meet(m.r[0], m.r[1], m.r[3]);
    const double shift_x = glm::dot(m.axis(0), forward), shift_y = glm::dot(m.axis(1), forward);
    const dvec3 x = m.axis(0) - shift_x * forward, y = m.axis(1) - shift_y * forward;

    LentCamera lent;
    set_axes(lent.camera, x, y, forward, width, height);
    lent.camera.position_ws = vec3(eye);
    lent.camera.yfov = static_cast<float>(2 * std::atan(1 / glm::length(y)));
    lent.camera.shift_cs = vec2(static_cast<float>(shift_x), static_cast<float>(shift_y));
    lent.z_scale = glm::dot(m.axis(2), forward);
    lent.z_offset = m.r[2].w - lent.z_scale * m.r[3].w;
    set_range(lent, reversed, farthest_along(bounds_ws, eye, forward));
    return lent;
}

LentCamera orthographic(Rows m, bool reversed, uint width, uint height) {
    for (dvec4& row : m.r) {
        row /= m.r[3].w;
    }
    const double per_metre = glm::length(m.axis(2));
    if (!(per_metre > 0)) {
        fail("the camera's matrix has no depth; {}", want);
    }
    const dvec3 forward = m.axis(2) / per_metre * (reversed ? -1.0 : 1.0);
    const double range = 1 / per_metre, before = 1e-3 * range;

    // The eye stands a little before the near plane, where x and y are 0.
    dvec4 plane = m.r[2];
    plane.w -= reversed ? 1 : 0;
    const dvec3 eye = meet(m.r[0], m.r[1], plane) - before * forward;
    LentCamera lent;
    set_axes(lent.camera, m.axis(0), m.axis(1), forward, width, height);
    lent.camera.position_ws = vec3(eye);
    lent.camera.half_height = static_cast<float>(1 / glm::length(m.axis(1)));
    lent.camera.near = static_cast<float>(before);
    lent.camera.far = static_cast<float>(before + range);
    lent.z_scale = reversed ? -range : range;
    lent.z_offset = before + (reversed ? range : 0);
    return lent;
}

}  // namespace

LentCamera camera_of(const mat4& cs_from_ws, bool reversed_depth, uint width, uint height, const Box& bounds_ws) {
    const Rows m = rows_of(cs_from_ws);
    for (const dvec4& row : m.r) {
        if (!std::isfinite(glm::dot(row, row))) {
            fail("the camera's matrix holds what is no number; {}", want);
        }
    }
    const double bent = glm::length(m.axis(3));
    if (bent > 1e-9 * std::abs(m.r[3].w)) {
        return perspective(m, reversed_depth, width, height, bounds_ws);
    }
    if (m.r[3].w == 0) {
        fail("the camera's matrix has no last row; {}", want);
    }
    return orthographic(m, reversed_depth, width, height);
}

}  // namespace gn::embed
