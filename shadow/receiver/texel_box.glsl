// SPDX-License-Identifier: MIT
// The texels of a map that a box around the receiver covers, and what share of each: of a box of one texel those of bilinear
// filtering. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_RECEIVER_TEXEL_BOX_GLSL
#define GN_SHADOW_RECEIVER_TEXEL_BOX_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

struct GnTexelBox {
    vec2 low;     // corners, in texels of the layer
    vec2 high;
    ivec2 first;  // texels
    ivec2 last;
};

// Texels along a side of the largest box.
const float gn_widest_box = 8.0f;

// Where a point is seen, in ts: a receiver before any bias moves it.
GN_FN vec2 gn_seen_at(GnLightView view, vec3 p_ws) {
    return gn_layer_place(view, gn_place(view, gn_clip(view, p_ws)));
}

// The box of this half extent around a place in ts, at least half a texel and at most four, without what lies beyond the view.
GN_FN GnTexelBox gn_texel_box(GnProjected projected, vec2 uv_ts, vec2 half_ts) {
    vec2 at = uv_ts / projected.texel_ts;
    vec2 reach = clamp(half_ts / projected.texel_ts, vec2(0.5f), vec2(0.5f * gn_widest_box));
    vec2 first = vec2(projected.bounds_ts.x, projected.bounds_ts.y) / projected.texel_ts;
    vec2 end = vec2(projected.bounds_ts.z, projected.bounds_ts.w) / projected.texel_ts;
    GnTexelBox box;
    box.low = at - reach;
    box.high = at + reach;
    box.first = ivec2(clamp(floor(box.low), floor(first + 0.5f), floor(end - 0.5f)));
    box.last = ivec2(clamp(floor(box.high), floor(first + 0.5f), floor(end - 0.5f)));
    return box;
}

// Texels of the box that a texel covers.
GN_FN float gn_box_weight(GnTexelBox box, ivec2 texel) {
    vec2 covered = min(box.high, vec2(texel) + 1.0f) - max(box.low, vec2(texel));
    return max(covered.x, 0.0f) * max(covered.y, 0.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
