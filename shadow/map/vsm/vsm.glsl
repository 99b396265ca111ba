// SPDX-License-Identifier: MIT
// Variance shadow maps: two moments of depth and Chebyshev's bound.
// Based on: Donnelly, Lauritzen. Variance Shadow Maps. I3D 2006. [DL06]
// The mean depth of what hides the light: Yang, Dong, Feng, Seidel, Kautz. Variance Soft Shadow Mapping. Pacific Graphics 2010.
// [YDF+10]
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
// Squares anywhere: Decoret. N-Buffers for Efficient Depth Map Query. Computer Graphics Forum 2005. [Dec05]
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

// Squares that stand for the rectangle of a footprint: from where along each axis the first begins and how far apart they do, in
// texels, and how many there are, of side 2^level. They end where it does, and overlap where its sides are no powers of two. [Dec05]
// No more than eight lie along a side: those of a very long box are wider than it.
struct GnVsmSquares {
    vec2 first;
    vec2 apart;
    ivec2 count;
    int level;
};

GN_FN GnVsmSquares gn_vsm_squares_over(vec2 middle, vec2 side, vec4 bounds, int levels) {
    vec2 low = vec2(bounds.x, bounds.y);
    vec2 within = clamp(side, vec2(1.0f), vec2(bounds.z, bounds.w) - low);
    GnVsmSquares squares;
    float finest = max(floor(log2(min(within.x, within.y)) + 1.0e-3f), ceil(log2(max(within.x, within.y) / 8.0f) - 1.0e-3f));
    squares.level = clamp(int(finest), 0, levels - 1);
    float square = float(1 << squares.level);
    squares.count = clamp(ivec2(ceil(within / square - 1.0e-3f)), ivec2(1), ivec2(8));
    vec2 room = max(within - square, vec2(0.0f));
    squares.apart = room / max(vec2(squares.count) - 1.0f, vec2(1.0f));
    vec2 reach = squares.apart * (vec2(squares.count) - 1.0f) + square;
    squares.first = clamp(middle - 0.5f * reach, low, max(vec2(bounds.z, bounds.w) - reach, low));
    return squares;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Moments over the footprint, from mips or from squares.
vec2 gn_vsm_mean(GnLookup at, sampler2DArray moments, sampler2DArray squares, vec2 ddx_ts, vec2 ddy_ts, GnVsmParams params) {
    if (params.squares == 0) {
        return gn_map_mean(moments, at.projected, at.projected.layer, ddx_ts, ddy_ts).xy;
    }
    float texels = 1.0 / at.projected.texel_ts;
    int levels = findMSB(textureSize(squares, 0).x) + 1;
    GnVsmSquares over = gn_vsm_squares_over(at.projected.uv_ts * texels, (abs(ddx_ts) + abs(ddy_ts)) * texels,
                                            at.projected.bounds_ts * texels, levels);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < over.count.x * over.count.y; ++i) {
        vec2 start = over.first + over.apart * vec2(i % over.count.x, i / over.count.x);
        sum += textureLod(squares, vec3((start + 0.5) * at.projected.texel_ts, at.projected.layer * levels + over.level), 0.0).xy;
    }
    return sum / float(over.count.x * over.count.y);
}

vec2 gn_vsm_blockers(GnLookup at, sampler2DArray moments, sampler2DArray squares, vec2 ddx_ts, vec2 ddy_ts, GnVsmParams params) {
    vec2 m = gn_vsm_mean(at, moments, squares, ddx_ts, ddy_ts, params);
    float deviation = gn_vsm_deviation(at.projected, params.min_deviation);
    return gn_vsm_found(gn_vsm_limit(m, params.max_deviation), at.projected.depth, deviation * deviation);
}

float gn_vsm_visibility(GnLookup at, sampler2DArray moments, sampler2DArray squares, vec2 ddx_ts, vec2 ddy_ts, GnVsmParams params) {
    GnProjected projected = at.projected;
    vec2 m = gn_vsm_mean(at, moments, squares, ddx_ts, ddy_ts, params);
    float deviation = gn_vsm_deviation(projected, params.min_deviation);
    m = gn_vsm_limit(m, params.max_deviation);
    float bound = gn_vsm_chebyshev(m, projected.depth, deviation * deviation);
    return gn_vsm_reduce(bound, params.bleeding, params.reduction);
}

#endif
#endif
