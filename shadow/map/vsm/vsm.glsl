// SPDX-License-Identifier: MIT
// Variance shadow maps: two moments of depth and Chebyshev's bound.
// Based on: Donnelly, Lauritzen. Variance Shadow Maps. I3D 2006. [DL06]
// The mean depth of what hides the light: Yang, Dong, Feng, Seidel, Kautz. Variance Soft Shadow Mapping. Pacific Graphics 2010.
// [YDF+10]
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
#ifndef GN_SHADOW_MAP_VSM_GLSL
#define GN_SHADOW_MAP_VSM_GLSL

#include "shadow/map/vsm/vsm.h"
#include "shadow/receiver/map_mean.glsl"
#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// [DL06] 4.1: the variance of a plane's depth over a texel that is a Gaussian of half its side.
GN_FN float gn_vsm_spread(float ddx, float ddy) { return 0.25f * (ddx * ddx + ddy * ddy); }

// Moments of a texel that a plane crosses: its spread joins the second. Depths lie in [0,1], as far to one side of their
// mean as to the other, so that it is at most the square of the way to the nearer end.
GN_FN vec2 gn_vsm_moments(float depth, float spread) {
    float room = min(depth, 1.0f - depth);
    return vec2(depth, depth * depth + min(spread, room * room));
}

// [DL06] eq. 5: no more than this share of the distribution lies at or beyond `depth`.
GN_FN float gn_vsm_chebyshev(vec2 moments, float depth, float min_variance) {
    float variance = max(moments.y - moments.x * moments.x, min_variance);
    float distance = depth - moments.x;
    GN_EXPECT(gn_finite(moments.x) && gn_finite(moments.y) && gn_finite(depth));
    return distance <= 0.0f ? 1.0f : variance / (variance + distance * distance);
}

// A limit to the variance: what bleeds goes with it, and so does the light of wide penumbrae.
GN_FN vec2 gn_vsm_limit(vec2 moments, float max_deviation) {
    return vec2(moments.x, min(moments.y, moments.x * moments.x + max_deviation * max_deviation));
}

// The least standard deviation assumed, in depth: what the moments of a texel say of a surface is blurred by about the
// length of a texel.
GN_FN float gn_vsm_deviation(GnProjected projected, float texels) {
    return texels * projected.texel_ws / projected.metres_per_depth;
}

// [Lau08] 3.4: the tail below `amount` is cut off, the rest stretched.
GN_FN float gn_vsm_reduce_bleeding(float bound, float amount) {
    return clamp((bound - amount) / (1.0f - amount), 0.0f, 1.0f);
}

// The same as a straight line, or bent so that it leaves the ends without a crease.
GN_FN float gn_vsm_reduce(float bound, float amount, int reduction) {
    float v = gn_vsm_reduce_bleeding(bound, amount);
    return reduction == GN_VSM_SMOOTHSTEP ? v * v * (3.0f - 2.0f * v) : v;
}

// The share that lies before `depth`, at least, and its mean depth: the rest is taken for the receiver's own. [YDF+10]
GN_FN vec2 gn_vsm_found(vec2 moments, float depth, float min_variance) {
    float lit = gn_vsm_chebyshev(moments, depth, min_variance);
    return vec2(1.0f - lit, (moments.x - lit * depth) / max(1.0f - lit, 1.0e-6f));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

vec2 gn_vsm_blockers(GnLookup at, sampler2DArray moments, vec2 ddx_ts, vec2 ddy_ts, GnVsmParams params) {
    vec2 m = gn_map_mean(moments, at.projected, at.projected.layer, ddx_ts, ddy_ts).xy;
    float deviation = gn_vsm_deviation(at.projected, params.min_deviation);
    return gn_vsm_found(gn_vsm_limit(m, params.max_deviation), at.projected.depth, deviation * deviation);
}

float gn_vsm_visibility(GnLookup at, sampler2DArray moments, vec2 ddx_ts, vec2 ddy_ts, GnVsmParams params) {
    GnProjected projected = at.projected;
    vec2 m = gn_map_mean(moments, projected, projected.layer, ddx_ts, ddy_ts).xy;
    float deviation = gn_vsm_deviation(projected, params.min_deviation);
    m = gn_vsm_limit(m, params.max_deviation);
    float bound = gn_vsm_chebyshev(m, projected.depth, deviation * deviation);
    return gn_vsm_reduce(bound, params.bleeding, params.reduction);
}

#endif
#endif
