// SPDX-License-Identifier: MIT
// Layered variance shadow maps: each layer stretches one interval of depths over the whole range of its two moments.
// Based on: Lauritzen, McCool. Layered Variance Shadow Maps. Graphics Interface 2008. [LM08]
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
// Departs from it: a relaxed split lies behind the surface it was found on, not in it, and transitions behind the split.
#ifndef GN_SHADOW_MAP_LVSM_GLSL
#define GN_SHADOW_MAP_LVSM_GLSL

#include "shadow/map/lvsm/lvsm.h"
#include "shadow/map/vsm/vsm.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Two layers share a texture.
GN_FN int gn_lvsm_textures(int layers) { return (layers + 1) / 2; }

// [Lau08] 4.1.1: layers reach over their splits by this much depth on either side.
GN_FN float gn_lvsm_overlap(GnLvsmParams params) { return params.overlap / float(params.layers); }

// The interval of layer i between two splits, widened where it has a neighbour.
GN_FN vec2 gn_lvsm_interval(int i, float near_split, float far_split, GnLvsmParams params) {
    float reach = gn_lvsm_overlap(params);
    return vec2(i == 0 ? near_split : near_split - reach, i == params.layers - 1 ? far_split : far_split + reach);
}

// A relaxed split sits on a surface, the second occluder. Put it one overlap behind, and no less than the histogram's bins
// blur it: the surface lies whole in the nearer layer, and flat on the front of the farther.
GN_FN float gn_lvsm_behind(float second_occluder, int k, GnLvsmParams params) {
    float behind = max(gn_lvsm_overlap(params), 2.0f / float(GN_LVSM_BINS));
    return k == 0 || k == params.layers ? second_occluder : second_occluder + behind;
}

GN_FN float gn_lvsm_width(vec2 interval) { return max(interval.y - interval.x, 1.0e-5f); }

// [Lau08] eq. 4.2.
GN_FN float gn_lvsm_warp(float depth, vec2 interval) {
    return clamp((depth - interval.x) / gn_lvsm_width(interval), 0.0f, 1.0f);
}

// Moments of a warped depth; its plane's spread over the texel is stretched with it, and vanishes where the warp is flat.
GN_FN vec2 gn_lvsm_moments(float depth, float spread, vec2 interval) {
    float width = gn_lvsm_width(interval);
    return gn_vsm_moments(gn_lvsm_warp(depth, interval), spread / (width * width));
}

// Variance that may be rounding: each of the three times that a moment in fixed point is rounded (drawn, blurred twice)
// moves M2 - M1^2 by half a unit for the second moment and by 2 M1 times that for the first.
GN_FN float gn_lvsm_rounding(float mean, int format) {
    float unit = format == GN_LVSM_FLOAT32 ? 0.0f : 1.0f / (format == GN_LVSM_UNORM8 ? 255.0f : 65535.0f);
    return 1.5f * (1.0f + 2.0f * mean) * unit;
}

// Visibility of a receiver in one layer: Chebyshev's bound on the warped distribution.
GN_FN float gn_lvsm_bound(vec2 moments, float depth, vec2 interval, float min_deviation, GnLvsmParams params) {
    float deviation = min_deviation / gn_lvsm_width(interval);
    float min_variance = max(deviation * deviation, gn_lvsm_rounding(moments.x, params.format));
    return gn_vsm_reduce_bleeding(gn_vsm_chebyshev(moments, gn_lvsm_warp(depth, interval), min_variance),
                                  params.bleeding);
}

// How much of the farther layer a receiver takes that lies `beyond` a split: from 0 to 1 between the split and the end of
// the nearer layer. Before the split the farther layer's front is too near: what lies flat on it seems lit.
GN_FN float gn_lvsm_transition(float beyond, float reach) {
    return reach > 0.0f ? smoothstep(0.0f, reach, beyond) : 1.0f;
}

GN_FN float gn_lvsm_between(float nearer, float farther, float beyond, float reach) {
    return mix(nearer, farther, gn_lvsm_transition(beyond, reach));
}

// The layer of a depth between equal splits: computed, where relaxed ones must be searched. [Lau08] 4.1.3
GN_FN int gn_lvsm_equal_layer(float depth, int layers) {
    return int(clamp(depth * float(layers), 0.0f, float(layers - 1)));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

float gn_lvsm_split(sampler2DArray splits, int map_layer, int k, GnLvsmParams params) {
    return params.splits == GN_LVSM_UNIFORM
               ? float(k) / float(params.layers)
               : gn_lvsm_behind(texelFetch(splits, ivec3(k, map_layer, 0), 0).r, k, params);
}

float gn_lvsm_layer_visibility(sampler2DArray map, sampler2DArray splits, GnProjected projected, vec2 ddx_ts,
                               vec2 ddy_ts, int i, GnLvsmParams params) {
    vec2 interval = gn_lvsm_interval(i, gn_lvsm_split(splits, projected.layer, i, params),
                                     gn_lvsm_split(splits, projected.layer, i + 1, params), params);
    int texture_layer = projected.layer * gn_lvsm_textures(params.layers) + i / 2;
    vec4 texel = gn_map_mean(map, projected, texture_layer, ddx_ts, ddy_ts);
    return gn_lvsm_bound((i & 1) == 0 ? texel.xy : texel.zw, projected.depth, interval,
                         gn_vsm_deviation(projected, params.min_deviation), params);
}

float gn_lvsm_visibility(GnLookup at, sampler2DArray moments, sampler2DArray splits, vec2 ddx_ts, vec2 ddy_ts, GnLvsmParams params) {
    GnProjected projected = at.projected;
    // Find the receiver's layer.
    int i = params.splits == GN_LVSM_UNIFORM ? gn_lvsm_equal_layer(projected.depth, params.layers) : 0;
    while (params.splits != GN_LVSM_UNIFORM && i + 1 < params.layers &&
           projected.depth >= gn_lvsm_split(splits, projected.layer, i + 1, params)) {
        ++i;
    }
    float near_split = gn_lvsm_split(splits, projected.layer, i, params);
    float far_split = gn_lvsm_split(splits, projected.layer, i + 1, params);

    // Just behind a split both its layers answer.
    float reach = min(params.transition * gn_lvsm_overlap(params), far_split - near_split);
    float v = gn_lvsm_layer_visibility(moments, splits, projected, ddx_ts, ddy_ts, i, params);
    if (i > 0 && projected.depth - near_split < reach) {
        float nearer = gn_lvsm_layer_visibility(moments, splits, projected, ddx_ts, ddy_ts, i - 1, params);
        v = gn_lvsm_between(nearer, v, projected.depth - near_split, reach);
    }
    return v;
}

#endif
#endif
