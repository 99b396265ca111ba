// SPDX-License-Identifier: MIT
// The surface between the two nearest: where a texel lies in the world, how large it is there, and the depth to store.
// Compiles as GLSL and as C++.
// Based on: Woo. The Shadow Depth Map Revisited. Graphics Gems III 1992. [Woo92]
// Based on: Weiskopf, Ertl. Shadow Mapping Based on Dual Depth Layers. Eurographics 2003. [WE03]
#ifndef GN_SHADOW_MAP_CASTERS_GLSL
#define GN_SHADOW_MAP_CASTERS_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The point of uv_ts's ray at a linear depth.
GN_FN vec3 gn_point_at(GnLightView view, vec2 uv_ts, float depth) {
    vec2 p_ndc = gn_ndc_at(view, uv_ts);
    if (gn_bent(view)) {
        vec3 p_ls = gn_paraboloid_ray(p_ndc * view.paraboloid) * (depth * view.metres_per_depth);
        return vec3(view.ws_from_cs * vec4(p_ls, 1.0f));
    }
    // Linear depth is affine along the ray from the near to the far plane.
    vec4 a = view.ws_from_cs * vec4(p_ndc, 0.0f, 1.0f);
    vec4 b = view.ws_from_cs * vec4(p_ndc, 1.0f, 1.0f);
    vec3 near_ws = vec3(a) / a.w;
    vec3 far_ws = vec3(b) / b.w;
    float near_depth = dot(view.depth_from_ws, vec4(near_ws, 1.0f));
    float far_depth = dot(view.depth_from_ws, vec4(far_ws, 1.0f));
    return near_ws + (far_ws - near_ws) * ((depth - near_depth) / (far_depth - near_depth));
}

// How far behind the nearest surface the stored one may lie, in linear depth.
GN_FN float gn_dual_limit(GnLightView view, vec2 uv_ts, float nearest, GnBias bias) {
    vec3 p_ws = gn_point_at(view, uv_ts, nearest);
    vec3 du_ws;
    vec3 dv_ws;
    gn_uv_gradients(view, p_ws, du_ws, dv_ws);
    float texel_ws = 1.0f / (view.resolution * min(length(du_ws), length(dv_ws)));
    float texels_ws = gn_bias_growth(bias, texel_ws, 0.0f) * texel_ws;
    return (bias.dual * texels_ws + bias.dual_world) * gn_depth_per_metre(view, gn_to_eye(view, p_ws));
}

// Half way between the two surfaces, at most `limit` behind the nearer.
GN_FN float gn_between(float nearest, float second, float limit) {
    return min(0.5f * (nearest + second), nearest + limit);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
