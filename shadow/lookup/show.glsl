// SPDX-License-Identifier: MIT
// What pictures of the hidden measure at a receiver. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_LOOKUP_SHOW_GLSL
#define GN_SHADOW_LOOKUP_SHOW_GLSL

#include "shadow/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Map texels along a pixel's side, in the direction that has fewest: the smaller singular value of the texel
// coordinates' derivative over the pixel's. Below 1 the map's texels are seen as steps.
GN_FN float gn_texels_per_pixel(GnReceiver receiver, GnProjected projected) {
    float ux = dot(projected.du_ws, receiver.ddx_ws) / projected.texel_ts;
    float vx = dot(projected.dv_ws, receiver.ddx_ws) / projected.texel_ts;
    float uy = dot(projected.du_ws, receiver.ddy_ws) / projected.texel_ts;
    float vy = dot(projected.dv_ws, receiver.ddy_ws) / projected.texel_ts;
    float area = ux * vy - vx * uy;
    float squares = ux * ux + vx * vx + uy * uy + vy * vy;
    float root = sqrt(max(squares * squares - 4.0f * area * area, 0.0f));
    return squares > 0.0f ? abs(area) * sqrt(2.0f / (squares + root)) : 0.0f;
}

// Metres between a receiver projected with its bias and without: the step in the world that changes uv and depth so, to
// first order.
GN_FN float gn_bias_metres(GnReceiver receiver, GnLightView view, GnProjected moved, GnProjected still) {
    vec3 along_ws = view.paraboloid > 0.0f ? -gn_to_eye(view, receiver.p_ws) / view.metres_per_depth
                                           : vec3(view.depth_from_ws);
    vec2 change_ts = moved.uv_ts - still.uv_ts;
    vec3 step_ws = change_ts.x * cross(still.dv_ws, along_ws) + change_ts.y * cross(along_ws, still.du_ws) +
                   (moved.depth - still.depth) * cross(still.du_ws, still.dv_ws);
    float determinant = dot(still.du_ws, cross(still.dv_ws, along_ws));
    return determinant != 0.0f ? length(step_ws) / abs(determinant) : 0.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
