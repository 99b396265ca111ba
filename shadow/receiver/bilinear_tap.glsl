// SPDX-License-Identifier: MIT
// A tap as a comparing sampler takes it: the four texels around it, each compared with the receiver's plane at its own centre,
// weighed bilinearly. Such taps follow the receiver continuously where taps of single texels jump. Compiles as GLSL and as C++.
// Based on: Reeves, Salesin, Cook. Rendering Antialiased Shadows with Depth Maps. SIGGRAPH 1987. [RSC87]
// In place of single texels: Kreuzer. Using Perception-Based Filtering to Hide Shadow Artifacts. TU Wien 2017. [Kre17], chapter 3.
#ifndef GN_SHADOW_BILINEAR_TAP_GLSL
#define GN_SHADOW_BILINEAR_TAP_GLSL

#include "shadow/receiver/map_access.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The corner that the four texels around a tap share, and how far the tap is on the way from the first centre to the others'.
struct GnBilinear {
    vec2 corner_ts;
    vec2 share;
};

GN_FN GnBilinear gn_bilinear(vec2 tap_ts, float texel_ts) {
    vec2 t = tap_ts / texel_ts - 0.5f;
    vec2 first = floor(t);
    GnBilinear tap;
    tap.corner_ts = (first + 1.0f) * texel_ts;
    tap.share = t - first;
    return tap;
}

// The mean of four comparisons in the order of a gather, (0,1), (1,1), (1,0), (0,0). Where all are alike it is 0 or 1 to the bit.
GN_FN float gn_bilinear_mean(vec4 lit, vec2 share) {
    float low = lit.w + share.x * (lit.z - lit.w);
    float high = lit.x + share.x * (lit.y - lit.x);
    return low + share.y * (high - low);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Where kernels cross views (shadow/receiver/map_access.glsl), taps beyond the receiver's are looked up in their own.
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view

// Whether the four texels around a corner lie in the receiver's own view; where kernels do not cross views they are read there.
bool gn_gathers_within(GnProjected projected, vec2 corner_ts) {
#ifdef GN_CROSSING
    vec2 reach_ts = vec2(projected.texel_ts);
    return gn_within_view(projected, corner_ts - reach_ts, corner_ts + reach_ts);
#else
    return true;
#endif
}

// Which of the four texels around a corner leave the receiver's plane lit, 1 or 0 each, in the order of a gather; beyond the
// receiver's view one by one, in the views that serve them.
vec4 gn_lit_gather(sampler2DArray depth, GnLookup at, vec2 corner_ts) {
    float half_ts = 0.5 * at.projected.texel_ts;
    vec2 d_ts = corner_ts - at.projected.uv_ts;
#ifdef GN_CROSSING
    if (!gn_gathers_within(at.projected, corner_ts)) {
        vec4 across;
        for (int k = 0; k < 4; ++k) {
            vec2 side = vec2(k == 1 || k == 2 ? half_ts : -half_ts, k < 2 ? half_ts : -half_ts);
            across[k] = float(gn_lit_tap(depth, at, corner_ts + side));
        }
        return across;
    }
#endif
    vec4 occluder = gn_map_gather(depth, at, corner_ts);
    return vec4(gn_lit_beside(at.projected, d_ts.x + vec4(-half_ts, half_ts, half_ts, -half_ts),
                              d_ts.y + vec4(half_ts, half_ts, -half_ts, -half_ts), occluder, at.bias));
}

// Where kernels end with their view, taps are clamped to its outermost centres, as a sampler that clamps to its edge does.
GnBilinear gn_bilinear_in_view(GnProjected projected, vec2 tap_ts) {
#ifndef GN_CROSSING
    float half_ts = 0.5 * projected.texel_ts;
    tap_ts = clamp(tap_ts, projected.bounds_ts.xy + half_ts, projected.bounds_ts.zw - half_ts);
#endif
    return gn_bilinear(tap_ts, projected.texel_ts);
}

// The share of a tap that is lit.
float gn_bilinear_tap(sampler2DArray depth, GnLookup at, vec2 tap_ts) {
    GnBilinear tap = gn_bilinear_in_view(at.projected, tap_ts);
    return gn_bilinear_mean(gn_lit_gather(depth, at, tap.corner_ts), tap.share);
}

#endif
#endif
