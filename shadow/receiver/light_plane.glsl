// SPDX-License-Identifier: MIT
// Lengths on the plane that a light sees the scene through: metres for a sun, for lights with a position tangents, which are
// metres at one metre along the view's axis. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_LIGHT_PLANE_GLSL
#define GN_SHADOW_LIGHT_PLANE_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What a view covers of the plane, along its u axis and its v axis. Of a paraboloid in its own coordinates.
GN_FN vec2 gn_light_plane(GnLightView view) {
    if (gn_bent(view)) {
        return vec2(2.0f * view.paraboloid);
    }
    vec3 x = gn_row(view.cs_from_ws, 0);
    vec3 y = gn_row(view.cs_from_ws, 1);
    vec3 w = gn_row(view.cs_from_ws, 3);
    float w_w = dot(w, w);
    if (w_w == 0.0f) {
        return vec2(2.0f / length(x), 2.0f / length(y));
    }
    // The rows of a shifted frustum have a part along the axis, which moves the rectangle and does not scale it.
    return vec2(2.0f * sqrt(w_w) / length(x - w * (dot(x, w) / w_w)), 2.0f * sqrt(w_w) / length(y - w * (dot(y, w) / w_w)));
}

// A length of uv along both axes, on the light's plane.
GN_FN vec2 gn_on_light_plane(GnLightView view, vec2 length_ts) {
    return length_ts / vec2(view.rect_ts.z, view.rect_ts.w) * gn_light_plane(view);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
