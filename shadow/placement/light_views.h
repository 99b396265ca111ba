// SPDX-License-Identifier: MIT
// Light views around convex bodies: orthographic for the sun, perspective for lights with a position.
#pragma once

#include "shadow/geometry/convex_body.h"
#include "shadow/recipe/guard.h"
#include "shadow/stages.h"

#include <cstddef>
#include <span>
#include <vector>

namespace gn {

/// A rotation-free description of an orthographic or perspective light view.
struct Fitted {
    GnLightView view;
    bool valid = false;
};
/// The tightest orthographic view along the light's direction around the body: the rectangle of least area. Casters
/// before the near plane are kept by depth clamping. Guards widen it. `texels`: across and down; the view gets the first.
GnLightView fit_orthographic(const ConvexBody& body, const GnLight& light, ivec2 texels, Guard guard);
/// The tightest perspective view from the light's position, near and far planes the body's own, or invalid when the body
/// spans too wide an angle.
Fitted fit_perspective(const ConvexBody& body, const GnLight& light, ivec2 texels, Guard guard);
/// The same with as many texels across as down.
inline GnLightView fit_orthographic(const ConvexBody& body, const GnLight& light, int resolution, Guard guard) {
    return fit_orthographic(body, light, ivec2(resolution), guard);
}
inline Fitted fit_perspective(const ConvexBody& body, const GnLight& light, int resolution, Guard guard) {
    return fit_perspective(body, light, ivec2(resolution), guard);
}
/// A square perspective view along `axis` with half-angle tangent 1 x widen and linear depth between near and far.
GnLightView square_perspective(vec3 eye_ws, vec3 axis_ws, vec3 up_ws, double tangent, double near, double far,
                               int resolution);

/// Six perspective views around the light, layers in the order of gn_face_of, each wider than 90 degrees by the kernels'
/// reach; sets views, layers and data[0] = (light's position, 1).
void add_cube_views(LightViews& views, const FrameInput& input, const Guard& guard, int resolution);

/// Objects that the light, passing through the view's rectangle, can meet before the view's far plane.
/// `least`: without those whose bounds span fewer texels than this to the longer side; 0 leaves none out.
std::vector<std::uint32_t> casters_of(const Scene& scene, const GnLightView& view, float least = 0);

/// Rows x, y and w of each view's clip space.
std::vector<vec4> clip_rows(std::span<const GnLightView> views);

/// Elements of a placement's table as they travel.
template <class T>
std::vector<std::byte> bytes_of(const std::vector<T>& elements) {
    const auto bytes = std::as_bytes(std::span(elements));
    return {bytes.begin(), bytes.end()};
}

/// Distance to the near plane of a light whose receivers may be anywhere: small, since depth is linear and costs no precision.
double near_plane(double far);

}  // namespace gn
