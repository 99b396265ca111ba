// SPDX-License-Identifier: MIT
// Summed-area variance shadow maps: moments of any box of texels from the corners of a table.
// Based on: Lauritzen. Summed-Area Variance Shadow Maps. GPU Gems 3, 2007. [Lau07]
// Departs from it: boxes of whole texels are blended at four offsets, so that both kinds of table filter alike.
#ifndef GN_SHADOW_MAP_SAT_VSM_GLSL
#define GN_SHADOW_MAP_SAT_VSM_GLSL

#include "shadow/map/sat_vsm/sat_vsm.h"
#include "shadow/map/sums.glsl"
#include "shadow/map/vsm/vsm.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Along one axis: a box of `size` texels, its first texel, and how far the receiver lies towards the next box.
struct GnSatSpan {
    int first;
    int size;
    float weight;
};

// The span of `side` texels around t, rounded to whole ones.
GN_FN GnSatSpan gn_sat_span(float t, float side, int max_box) {
    GnSatSpan span;
    span.size = clamp(int(floor(side + 0.5f)), 1, max_box);
    float start = t - 0.5f * float(span.size);
    span.first = int(floor(start));
    span.weight = start - floor(start);
    return span;
}

// First texel and end of the span moved by `offset`, cut to [low, high) but never empty.
GN_FN ivec2 gn_sat_cut(GnSatSpan span, int offset, int low, int high) {
    int first = clamp(span.first + offset, low, high - 1);
    return ivec2(first, clamp(span.first + offset + span.size, first + 1, high));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Moments of the box that holds the footprint.
vec2 gn_sat_vsm_moments(GnLookup at, sampler2DArray sums, vec2 ddx_ts, vec2 ddy_ts, GnSatVsmParams params) {
    GnProjected projected = at.projected;
    // The box that holds the footprint, at least the kernel asked for.
    vec2 t = projected.uv_ts / projected.texel_ts;
    vec2 side = max((abs(ddx_ts) + abs(ddy_ts)) / projected.texel_ts, vec2(2.0 * params.radius + 1.0));
    GnSatSpan u = gn_sat_span(t.x, side.x, params.max_box);
    GnSatSpan v = gn_sat_span(t.y, side.y, params.max_box);
    ivec4 bounds = ivec4(projected.bounds_ts / projected.texel_ts + 0.5);

    // Blend its four positions of whole texels.
    vec2 moments = vec2(0.0);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
            float weight = (x == 0 ? 1.0 - u.weight : u.weight) * (y == 0 ? 1.0 - v.weight : v.weight);
            moments += weight * gn_sat_mean(sums, params.table, params.max_box, projected.layer,
                                            gn_sat_cut(u, x, bounds.x, bounds.z), gn_sat_cut(v, y, bounds.y, bounds.w)).xy;
        }
    }
    return gn_vsm_limit(moments, params.max_deviation);
}

float gn_sat_vsm_variance(GnProjected projected, GnSatVsmParams params) {
    float deviation = gn_vsm_deviation(projected, params.min_deviation);
    float rounding = params.table == GN_SAT_UINT32 ? 1.0 / gn_sat_levels(params.max_box) : 0.0;
    return max(deviation * deviation, rounding);
}

float gn_sat_vsm_visibility(GnLookup at, sampler2DArray sums, vec2 ddx_ts, vec2 ddy_ts, GnSatVsmParams params) {
    vec2 moments = gn_sat_vsm_moments(at, sums, ddx_ts, ddy_ts, params);
    float bound = gn_vsm_chebyshev(moments, at.projected.depth, gn_sat_vsm_variance(at.projected, params));
    return gn_vsm_reduce(bound, params.bleeding, params.reduction);
}

vec2 gn_sat_vsm_blockers(GnLookup at, sampler2DArray sums, vec2 ddx_ts, vec2 ddy_ts, GnSatVsmParams params) {
    vec2 moments = gn_sat_vsm_moments(at, sums, ddx_ts, ddy_ts, params);
    return gn_vsm_found(moments, at.projected.depth, gn_sat_vsm_variance(at.projected, params));
}

#endif
#endif
