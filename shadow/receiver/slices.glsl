// SPDX-License-Identifier: MIT
// Slices of what a view sees, parallel to the light: how far along them a point lies. Compiles as GLSL and as C++.
// Based on: Eisemann, Decoret. Plausible Image Based Soft Shadows Using Occlusion Textures. SIBGRAPI 2006. [ED06]
#ifndef GN_SHADOW_RECEIVER_SLICES_GLSL
#define GN_SHADOW_RECEIVER_SLICES_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Slices lie across the light's own axis where it is flat, else across the view's depth.
GN_FN bool gn_slices_turn(GnLight light, GnLightView view) {
    bool flat_light = light.kind == uint(GN_LIGHT_RECTANGLE) || light.kind == uint(GN_LIGHT_SPOT);
    return flat_light && view.eye_ws.w > 0.5f && !gn_bent(view);
}

// Linear depth of the view's eye, below 0; 0 where its rays do not meet.
GN_FN float gn_slices_eye(GnLightView view) {
    return view.eye_ws.w > 0.5f && !gn_bent(view) ? dot(view.depth_from_ws, vec4(vec3(view.eye_ws), 1.0f)) : 0.0f;
}

// Metres along the axis from the eye to what stands at uv and depth, or from the near plane where rays do not meet.
GN_FN float gn_slices_metres(GnLight light, GnLightView view, vec2 uv_ts, float depth) {
    float eye = gn_slices_eye(view);
    if (!gn_slices_turn(light, view)) {
        return (depth - eye) * view.metres_per_depth;
    }
    vec2 p_ndc = gn_ndc_at(view, uv_ts);
    vec4 seen_ws = view.ws_from_cs * vec4(p_ndc.x, p_ndc.y, 0.5f, 1.0f);
    vec3 ray_ws = vec3(seen_ws) / seen_ws.w - vec3(view.eye_ws);
    return dot(vec3(light.direction_ws), ray_ws) * (depth - eye) / dot(vec3(view.depth_from_ws), ray_ws);
}

// Metres to the bottom of the last slice: the farthest that the view holds.
GN_FN float gn_slices_end(GnLight light, GnLightView view) {
    if (!gn_slices_turn(light, view)) {
        return (1.0f - gn_slices_eye(view)) * view.metres_per_depth;
    }
    float end = 0.0f;
    for (int corner = 0; corner < 4; ++corner) {
        vec2 uv_ts = vec2(view.rect_ts.x, view.rect_ts.y) + vec2((corner & 1) == 0 ? 0.0f : view.rect_ts.z,
                                                               (corner & 2) == 0 ? 0.0f : view.rect_ts.w);
        end = max(end, gn_slices_metres(light, view, uv_ts, 1.0f));
    }
    return end;
}

// Metres to the bottom of slice k of `count`, and the slice that holds what is so many metres away: a bottom belongs to the slice
// above it, and so does what lies a thousandth of a slice below, for rounding.
GN_FN float gn_slice_bottom(int k, int count, float end) { return end * float(k + 1) / float(count); }
GN_FN int gn_slice_of(float metres, int count, float end) {
    return clamp(int(ceil(metres / max(end, 1.0e-30f) * float(count) - 1.0e-3f)) - 1, 0, count - 1);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
