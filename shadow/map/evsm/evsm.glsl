// SPDX-License-Identifier: MIT
// Exponential variance shadow maps: two moments of depth after each of two monotonic warps.
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
#ifndef GN_SHADOW_MAP_EVSM_GLSL
#define GN_SHADOW_MAP_EVSM_GLSL

#include "shadow/map/evsm/evsm.h"
#include "shadow/map/vsm/vsm.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The largest exponent of a format: the second moment is at most 2 exp(2 c), which must stay below 65504 or 3.4e38.
GN_FN float gn_evsm_limit(int format) { return format == GN_EVSM_FLOAT16 ? 5.0f : 42.0f; }

// The exponents of both warps; 0 stands for what is usual, as far as the format holds it. Others are refused beforehand.
GN_FN vec2 gn_evsm_exponents(GnEvsmParams params) {
    float limit = gn_evsm_limit(params.format);
    return vec2(params.exponent > 0.0f ? params.exponent : min(20.0f, limit),
                params.exponent_negative > 0.0f ? params.exponent_negative : min(10.0f, limit));
}

// Share of a second moment that may be rounding: four units of the format's significand.
GN_FN float gn_evsm_rounding(int format) { return format == GN_EVSM_FLOAT16 ? 1.0f / 512.0f : 1.0f / 4194304.0f; }

// [Lau08] 4.2: depth is stretched to [-1,1] first, so that both ends of the exponential's range are used.
GN_FN float gn_evsm_positive(float depth, float c) { return exp(c * (2.0f * depth - 1.0f)); }
GN_FN float gn_evsm_negative(float depth, float c) { return -exp(-c * (2.0f * depth - 1.0f)); }

// Moments of a warped depth whose plane changes by `slope` over a texel: the chain rule warps the slope too. The plane's
// share is at most the moment itself, which keeps the sum representable.
GN_FN vec2 gn_evsm_moments(float warped, float c, vec2 slope) {
    float square = warped * warped;
    float spread = c * c * dot(slope, slope);
    return vec2(warped, square + square * min(spread, 1.0f));
}

// What a texel stores: positive moments, then negative ones.
GN_FN vec4 gn_evsm_encode(float depth, vec2 slope, GnEvsmParams params) {
    vec2 c = gn_evsm_exponents(params);
    vec2 positive = gn_evsm_moments(gn_evsm_positive(depth, c.x), c.x, slope);
    vec2 negative = gn_evsm_moments(gn_evsm_negative(depth, c.y), c.y, slope);
    return vec4(positive.x, positive.y, negative.x, negative.y);
}

// Chebyshev's bound in one warped space; a deviation of depth becomes 2 c |warped| times as large there.
GN_FN float gn_evsm_bound(vec2 moments, float warped, float c, float deviation, int format) {
    float least = 2.0f * c * warped * deviation;
    return gn_vsm_chebyshev(moments, warped, max(least * least, gn_evsm_rounding(format) * moments.y));
}

// [Lau08] 4.2: both bounds hold, so the smaller does. `deviation` is the least one assumed, in depth.
GN_FN float gn_evsm_visible(vec4 moments, float depth, float deviation, GnEvsmParams params) {
    float d = clamp(depth, 0.0f, 1.0f);
    vec2 c = gn_evsm_exponents(params);
    float bound = gn_evsm_bound(vec2(moments.x, moments.y), gn_evsm_positive(d, c.x), c.x, deviation, params.format);
    if (params.components == GN_EVSM_FOUR) {
        float negative =
            gn_evsm_bound(vec2(moments.z, moments.w), gn_evsm_negative(d, c.y), c.y, deviation, params.format);
        bound = min(bound, negative);
    }
    return gn_vsm_reduce_bleeding(bound, params.bleeding);
}

// A bias b of depth makes w = exp(c z) smaller by its share 2 c b, many times what it is worth to a plain map. It is applied
// to w instead: the depth moves by 1 / (2 c) of it.
GN_FN float gn_evsm_receiver(GnProjected projected, float c) {
    return projected.depth + projected.bias * (1.0f - 0.5f / max(c, 0.5f));
}

// The share that lies before `depth`, and its mean depth, by the warp that keeps near depths apart: -exp(-c z) where it is stored.
GN_FN vec2 gn_evsm_found(vec4 moments, float depth, float deviation, GnEvsmParams params) {
    float d = clamp(depth, 0.0f, 1.0f);
    vec2 c = gn_evsm_exponents(params);
    bool four = params.components == GN_EVSM_FOUR;
    float warped = four ? gn_evsm_negative(d, c.y) : gn_evsm_positive(d, c.x);
    float mean = four ? moments.z : moments.x;
    float lit = gn_evsm_bound(vec2(moments.x, moments.y), gn_evsm_positive(d, c.x), c.x, deviation, params.format);
    if (four) {
        lit = min(lit, gn_evsm_bound(vec2(moments.z, moments.w), warped, c.y, deviation, params.format));
    }
    float share = max(1.0f - lit, 1.0e-6f);
    float blocker = abs((mean - lit * warped) / share);
    float z = log(max(blocker, 1.0e-30f)) / (four ? -c.y : c.x);
    return vec2(1.0f - lit, clamp(0.5f + 0.5f * z, 0.0f, d));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

vec2 gn_evsm_blockers(GnLookup at, sampler2DArray moments, vec2 ddx_ts, vec2 ddy_ts, GnEvsmParams params) {
    vec4 m = gn_map_mean(moments, at.projected, at.projected.layer, ddx_ts, ddy_ts);
    vec2 c = gn_evsm_exponents(params);
    float depth = gn_evsm_receiver(at.projected, max(c.x, c.y));
    return gn_evsm_found(m, depth, gn_vsm_deviation(at.projected, params.min_deviation), params);
}

float gn_evsm_visibility(GnLookup at, sampler2DArray moments, vec2 ddx_ts, vec2 ddy_ts, GnEvsmParams params) {
    GnProjected projected = at.projected;
    vec4 m = gn_map_mean(moments, projected, projected.layer, ddx_ts, ddy_ts);
    vec2 c = gn_evsm_exponents(params);
    float depth = gn_evsm_receiver(projected, max(c.x, c.y));
    return gn_evsm_visible(m, depth, gn_vsm_deviation(projected, params.min_deviation), params);
}

#endif
#endif
