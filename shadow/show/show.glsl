// SPDX-License-Identifier: MIT
// What pictures of the hidden measure at a receiver. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_LOOKUP_SHOW_GLSL
#define GN_SHADOW_LOOKUP_SHOW_GLSL

#include "shadow/receiver/undersampling.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Map texels along a pixel's side, in the direction that has fewest: the smaller singular value of the texel
// coordinates' derivative over the pixel's. Below 1 the map's texels are seen as steps.
GN_FN float gn_texels_per_pixel(GnReceiver receiver, GnProjected projected) {
    return 1.0f / gn_undersampling_in(receiver, projected);
}

// Metres between a receiver projected with its bias and without: the step in the world that changes uv and depth so, to
// first order.
GN_FN float gn_bias_metres(GnReceiver receiver, GnLightView view, GnProjected moved, GnProjected still) {
    vec3 along_ws = gn_bent(view) ? -gn_to_eye(view, receiver.p_ws) / view.metres_per_depth
                                           : vec3(view.depth_from_ws);
    vec2 change_ts = moved.uv_ts - still.uv_ts;
    vec3 step_ws = change_ts.x * cross(still.dv_ws, along_ws) + change_ts.y * cross(along_ws, still.du_ws) +
                   (moved.depth - still.depth) * cross(still.du_ws, still.dv_ws);
    float determinant = dot(still.du_ws, cross(still.dv_ws, along_ws));
    return determinant != 0.0f ? length(step_ws) / abs(determinant) : 0.0f;
}

// The region across the rays that a kernel draws a receiver's V from: the parallelogram p + s a + t b, s and t in
// [-1,1]. It holds the kernel with its bias.reach and reach_world, half a texel to the centre of the receiver's own, one
// more for what the bias moves, and `pixels` times the pixel's own footprint.
GN_FN void gn_kernel_region(GnReceiver receiver, GnLightView view, GnProjected projected, GnBias bias, float pixels,
                            GN_OUT(vec3) a_ws, GN_OUT(vec3) b_ws) {
    vec2 texels = max(vec2(bias.reach), gn_texels(projected, bias.reach_world)) + 1.5f;
    vec2 half_ts = texels * projected.texel_ts;
    half_ts.x += pixels * (abs(dot(projected.du_ws, receiver.ddx_ws)) + abs(dot(projected.du_ws, receiver.ddy_ws)));
    half_ts.y += pixels * (abs(dot(projected.dv_ws, receiver.ddx_ws)) + abs(dot(projected.dv_ws, receiver.ddy_ws)));

    // Steps across the rays that change one coordinate and keep the other.
    vec3 ray_ws = gn_to_eye(view, receiver.p_ws);
    float determinant = dot(projected.du_ws, cross(projected.dv_ws, ray_ws));
    a_ws = cross(projected.dv_ws, ray_ws) * (half_ts.x / determinant);
    b_ws = cross(ray_ws, projected.du_ws) * (half_ts.y / determinant);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
