// SPDX-License-Identifier: MIT
// What a kernel finds in one texel of the map: whether it hides the light from the receiver's plane, and from how far away.
#ifndef GN_SHADOW_LOOKUP_PCSS_TAP_GLSL
#define GN_SHADOW_LOOKUP_PCSS_TAP_GLSL

#include "shadow/receiver/light_extent.glsl"

#ifndef __cplusplus

// Where kernels cross views (shadow/receiver/map_access.glsl), taps beyond the receiver's are looked up in their own.
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view

struct GnPcssTap {
    float distance;  // metres along the axis
    bool lit;
};

// `metres` of the receiver's own view.
GnPcssTap gn_pcss_tap(GnLookup at, sampler2DArray depth, GnExtentMetres metres, vec2 tap_ts) {
    vec2 uv_ts;
    GnLookup tap = gn_tap_reader(at, tap_ts, uv_ts);
    vec2 last_ts = tap.projected.bounds_ts.zw - 0.5 * tap.projected.texel_ts;
    ivec2 texel = ivec2(floor(clamp(uv_ts, tap.projected.bounds_ts.xy, last_ts) / tap.projected.texel_ts));
    float occluder = gn_map_texel(depth, tap, texel).r;
    float plane = gn_depth_at(tap.projected, (vec2(texel) + 0.5) * tap.projected.texel_ts, tap.bias);
    bool lit = plane <= occluder;
    float distance = gn_extent_seen(at, tap, metres, tap_ts, uv_ts, plane, occluder);
    return GnPcssTap(distance, lit);
}

#endif
#endif
