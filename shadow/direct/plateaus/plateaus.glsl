// SPDX-License-Identifier: MIT
// Based on: Haines. Soft Planar Shadows Using Plateaus. Journal of Graphics Tools 2001. [Hai01]
//
// The rim of a plateau around the shadow of an edge; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_PLATEAUS_GLSL
#define GN_SHADOW_DIRECT_PLATEAUS_GLSL

#include "shadow/direct/plateaus/plateaus.h"
#include "shadow/geometry/flattened.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// How wide the rim is around the shadow of a point: of a lamp of the radius `size`, size h / (H - h); of a sun of the tangent
// `size`, the rays' way from the point to the plane times it.
GN_FN float gn_plateaus_width(vec4 plane_ws, vec4 light_ws, float size, vec3 e_ws) {
    float height = gn_plane_height(plane_ws, vec4(e_ws, 1.0f));
    float light_height = gn_plane_height(plane_ws, light_ws);
    return size * height / (light_ws.w > 0.0f ? light_height - height : light_height);
}

// Cuts an edge to what stands between the plane and the light, a little below it; false where nothing does.
GN_FN bool gn_plateaus_cut(vec4 plane_ws, vec4 light_ws, GN_INOUT(vec3) a_ws, GN_INOUT(vec3) b_ws) {
    float ha = gn_plane_height(plane_ws, vec4(a_ws, 1.0f));
    float hb = gn_plane_height(plane_ws, vec4(b_ws, 1.0f));
    float high = light_ws.w > 0.0f ? 0.95f * gn_plane_height(plane_ws, light_ws) : 1.0e30f;
    if (max(ha, hb) <= 0.0f || min(ha, hb) >= high) {
        return false;
    }
    vec3 along = b_ws - a_ws;
    float t0 = 0.0f;
    float t1 = 1.0f;
    if (ha != hb) {
        float at_low = -ha / (hb - ha);
        float at_high = (high - ha) / (hb - ha);
        t0 = clamp(min(at_low, at_high), 0.0f, 1.0f);
        t1 = clamp(max(at_low, at_high), 0.0f, 1.0f);
    }
    b_ws = a_ws + along * t1;
    a_ws = a_ws + along * t0;
    return true;
}

// The light at a point of the plane: a cone around the shadow of each end, from 0 at its tip to 1 at its width, and a sheet between
// them. a_ws and b_ws are shadows of the ends, wa and wb their widths.
GN_FN float gn_plateaus_light(vec3 p_ws, vec3 a_ws, float wa, vec3 b_ws, float wb) {
    vec3 along = b_ws - a_ws;
    vec3 from_a = p_ws - a_ws;
    float length2 = dot(along, along);
    float t = length2 > 0.0f ? clamp(dot(from_a, along) / length2, 0.0f, 1.0f) : 0.0f;
    vec3 off = from_a - along * t;
    return clamp(sqrt(dot(off, off)) / max(wa + (wb - wa) * t, 1.0e-30f), 0.0f, 1.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
