// SPDX-License-Identifier: MIT
// Variance shadow maps: two moments of depth and Chebyshev's bound.
// Based on: Donnelly, Lauritzen. Variance Shadow Maps. I3D 2006. [DL06]
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
#ifndef GN_SHADOW_MAP_VSM_GLSL
#define GN_SHADOW_MAP_VSM_GLSL

#include "shadow/map/vsm/vsm.h"
#include "shadow/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Moments of a texel that a plane crosses: [DL06] 4.1, the plane's spread over the texel joins the second.
GN_FN vec2 gn_vsm_moments(float depth, float ddx, float ddy) {
    return vec2(depth, depth * depth + 0.25f * (ddx * ddx + ddy * ddy));
}

// [DL06] eq. 5: no more than this share of the distribution lies at or beyond `depth`.
GN_FN float gn_vsm_chebyshev(vec2 moments, float depth, float min_variance) {
    float variance = max(moments.y - moments.x * moments.x, min_variance);
    float distance = depth - moments.x;
    GN_EXPECT(gn_finite(moments.x) && gn_finite(moments.y) && gn_finite(depth));
    return distance <= 0.0f ? 1.0f : variance / (variance + distance * distance);
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

#ifdef __cplusplus
}  // namespace gn::glsl
#else

float gn_vsm_visibility(sampler2DArray map, sampler2DArray extra, GnProjected projected, vec2 ddx_ts, vec2 ddy_ts,
                        GnVsmParams params) {
    vec2 moments = textureGrad(map, vec3(projected.uv_ts, projected.layer), ddx_ts, ddy_ts).xy;
    float deviation = gn_vsm_deviation(projected, params.min_deviation);
    float bound = gn_vsm_chebyshev(moments, projected.depth, deviation * deviation);
    return gn_vsm_reduce_bleeding(bound, params.bleeding);
}

#endif
#endif
