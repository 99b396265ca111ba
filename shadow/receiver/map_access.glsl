// SPDX-License-Identifier: MIT
// Reading a map through its placement: a texel, a gather, and the view of a tap. A kernel that leaves its view's rectangle
// goes on in the view that serves the tap: across the edge of a cube's face, of a cascade, of a tile.
#ifndef GN_SHADOW_RECEIVER_MAP_ACCESS_GLSL
#define GN_SHADOW_RECEIVER_MAP_ACCESS_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Whether texels from `low_ts` to `high_ts` lie in the receiver's own view.
GN_FN bool gn_within_view(GnProjected projected, vec2 low_ts, vec2 high_ts) {
    return low_ts.x >= projected.bounds_ts.x && low_ts.y >= projected.bounds_ts.y && high_ts.x <= projected.bounds_ts.z &&
           high_ts.y <= projected.bounds_ts.w;
}

// The way within the receiver's plane, in world space, that moves its uv by `d_ts`: e_u du + e_v dv as in gn_project, made
// exact by the division. Nothing where the plane is seen edge-on or ends before it gets there.
GN_FN vec3 gn_way_ws(GnReceiver receiver, GnLightView view, vec2 d_ts) {
    vec3 du_ws;
    vec3 dv_ws;
    gn_uv_gradients(view, receiver.p_ws, du_ws, dv_ws);
    float determinant = dot(du_ws, cross(dv_ws, receiver.n_ws));
    if (abs(determinant) <= 1.0e-4f * length(du_ws) * length(dv_ws)) {
        return vec3(0.0f);
    }
    d_ts.y = gn_log_step(d_ts.y, gn_log_rate(view) / view.rect_ts.w);
    vec3 way_ws = (cross(dv_ws, receiver.n_ws) * d_ts.x + cross(receiver.n_ws, du_ws) * d_ts.y) / determinant;
    float fall = dot(gn_row(view.cs_from_ws, 3), way_ws) / gn_clip(view, receiver.p_ws).w;
    return fall < 1.0f - gn_least_divisor && !gn_bent(view) ? way_ws / (1.0f - fall) : vec3(0.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// The texel of the receiver's layer, and the four around a corner in the order of textureGather.
vec4 gn_map_texel(sampler2DArray map, GnLookup at, ivec2 texel) {
    return texelFetch(map, ivec3(texel, at.projected.layer), 0);
}

vec4 gn_map_gather(sampler2DArray map, GnLookup at, vec2 corner_ts) {
    return textureGather(map, vec3(corner_ts, at.projected.layer));
}

// A host whose kernels may leave their views says which view serves a receiver, and which it is:
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view
#ifdef GN_CROSSING

// The lookup of a tap: of the point of the receiver's plane that it sees, in the view that serves this point. The receiver
// itself where the plane is seen edge-on, or where no view sees that point.
GnLookup gn_at_tap(GnLookup at, vec2 tap_ts) {
    vec3 way_ws = gn_way_ws(at.receiver, at.view, tap_ts - at.projected.uv_ts);
    if (way_ws == vec3(0.0)) {
        return at;
    }
    GnReceiver beside = at.receiver;
    beside.p_ws += way_ws;
    GnLightView view = at.view;
    if (!gn_within_view(at.projected, tap_ts, tap_ts)) {
        view = GN_LIGHT_VIEW(GN_CHOICE(beside).first);
    }
    GnLookup tap = GnLookup(beside, gn_project(beside, view, at.bias), at.bias, at.light, view);
    // What the cone takes off so far from the receiver, in the other view's depth.
    tap.projected.depth -= gn_cone(at.projected, tap_ts - at.projected.uv_ts) * at.projected.metres_per_depth /
                           tap.projected.metres_per_depth;
    return tap.projected.inside ? tap : at;
}

// Whether the texel that a tap falls into leaves the tap lit, wherever it lies. A tap that no view serves is clamped to the
// receiver's own.
bool gn_lit_tap(sampler2DArray depth, GnLookup at, vec2 tap_ts) {
    GnLookup tap = gn_at_tap(at, tap_ts);
    vec2 uv_ts = tap.receiver.p_ws == at.receiver.p_ws ? tap_ts : tap.projected.uv_ts;
    vec2 first_ts = tap.projected.bounds_ts.xy;
    vec2 last_ts = tap.projected.bounds_ts.zw - 0.5 * tap.projected.texel_ts;
    ivec2 texel = ivec2(floor(clamp(uv_ts, first_ts, last_ts) / tap.projected.texel_ts));
    vec2 centre_ts = (vec2(texel) + 0.5) * tap.projected.texel_ts;
    return gn_depth_at(tap.projected, centre_ts, tap.bias) <= gn_map_texel(depth, tap, texel).r;
}

#endif

// The lookup that reads a tap, and where the tap is in its view: the receiver's own, or beyond its view, where kernels cross
// views, that which serves the tap.
GnLookup gn_tap_reader(GnLookup at, vec2 tap_ts, out vec2 uv_ts) {
    uv_ts = tap_ts;
#ifdef GN_CROSSING
    if (!gn_within_view(at.projected, tap_ts, tap_ts)) {
        GnLookup tap = gn_at_tap(at, tap_ts);
        uv_ts = tap.receiver.p_ws == at.receiver.p_ws ? tap_ts : tap.projected.uv_ts;
        return tap;
    }
#endif
    return at;
}

#endif
#endif
