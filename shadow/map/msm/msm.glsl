// SPDX-License-Identifier: MIT
// Moment shadow maps: the least shadow that any distribution of depth with four given moments casts.
// Based on: Peters, Klein. Moment Shadow Mapping. I3D 2015. [PK15]
#ifndef GN_SHADOW_MAP_MSM_GLSL
#define GN_SHADOW_MAP_MSM_GLSL

#include "shadow/map/msm/msm.h"
#include "shadow/receiver/map_mean.glsl"
#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Moments are of z = 2 d - 1, so that odd and even ones are independent on a symmetric range.
GN_FN vec4 gn_msm_moments(float depth) {
    float z = 2.0f * depth - 1.0f;
    return vec4(z, z * z, z * z * z, z * z * z * z);
}

// The optimized quantization, [PK15] 3.5: four polynomials of z, even and odd apart, each of which takes all of [0,1]
// over [-1,1]. Being affine in the moments it commutes with any filter. Its determinant is 18.5 times that of halving
// and shifting the odd moments, so that a cell of the format's grid holds that much less of the space of moments.
GN_FN vec4 gn_msm_quantize(vec4 b) {
    return vec4(0.5f + 1.5f * b.x - 2.0f * b.z, 4.0f * (b.y - b.w), 0.5f + 0.8660254038f * b.x - 0.3849001795f * b.z,
                0.5f * (b.y + b.w));
}

GN_FN vec4 gn_msm_dequantize(vec4 q) {
    float s = q.x - 0.5f;
    float t = q.z - 0.5f;
    return vec4(-0.3333333333f * s + 1.7320508076f * t, q.w + 0.125f * q.y, -0.75f * s + 1.2990381057f * t,
                q.w - 0.125f * q.y);
}

GN_FN vec4 gn_msm_encode(float depth, int format) {
    vec4 b = gn_msm_moments(depth);
    return format == GN_MSM_UNORM16 ? gn_msm_quantize(b) : b;
}

// [PK15] eq. 5: rounding may leave the set of moments that a distribution can have; a little of a distribution inside
// it (masses 0.315, 0.37, 0.315 at -1, 0, 1) pulls them back.
GN_FN vec4 gn_msm_biased(vec4 b, float amount) {
    return (1.0f - amount) * b + amount * vec4(0.0f, 0.63f, 0.0f, 0.63f);
}

// A divisor that keeps its sign and is never zero.
GN_FN float gn_msm_nonzero(float x) { return abs(x) > 1.0e-7f ? x : (x < 0.0f ? -1.0e-7f : 1.0e-7f); }

// The other two points of the canonical representation that has the receiver z among its three points: roots of the
// quadratic orthogonal to it. [PK15] algorithm 2: Cholesky factors of the Hankel matrix, forward and back substitution.
GN_FN vec2 gn_msm_roots(vec4 b, float z) {
    float d22 = max(b.y - b.x * b.x, 1.0e-9f);
    float l32_d22 = b.z - b.x * b.y;
    float l32 = l32_d22 / d22;
    float d33 = max(b.w - b.y * b.y - l32_d22 * l32, 1.0e-12f);
    float c1 = z - b.x;
    float c2 = (z * z - b.y - l32 * c1) / d33;
    c1 = c1 / d22 - l32 * c2;
    float c0 = 1.0f - b.x * c1 - b.y * c2;
    float p = c1 / gn_msm_nonzero(c2);
    float q = c0 / gn_msm_nonzero(c2);
    float root = sqrt(max(0.25f * p * p - q, 0.0f));
    return vec2(-0.5f * p - root, -0.5f * p + root);
}

// Mass of the representation's point `at`, the others being `j` and `k`: the mean of the Lagrange polynomial.
GN_FN float gn_msm_mass(vec4 b, float at, float j, float k) {
    return (b.y - b.x * (j + k) + j * k) / gn_msm_nonzero((at - j) * (at - k));
}

// [PK15] 3.2: the least mass before z of any distribution on the line with these moments.
GN_FN float gn_msm_hamburger(vec4 b, float z) {
    vec2 roots = gn_msm_roots(b, z);
    if (z <= roots.x) {
        return 0.0f;
    }
    float shadow = z <= roots.y ? gn_msm_mass(b, roots.x, z, roots.y) : 1.0f - gn_msm_mass(b, z, roots.x, roots.y);
    GN_EXPECT(gn_finite(shadow));
    return clamp(shadow, 0.0f, 1.0f);
}

// [PK15] 3.3: the same for distributions on [-1,1]. Where the representation above stays inside it is the answer; else
// the extreme one has points -1, z, y, 1, where y follows from the mean of (1 - x^2)(x - z)(x - y) being zero.
GN_FN float gn_msm_hausdorff(vec4 b, float z) {
    vec2 roots = gn_msm_roots(b, z);
    if (roots.x >= -1.0f && roots.y <= 1.0f) {
        return gn_msm_hamburger(b, z);
    }
    float m0 = max(1.0f - b.y, 0.0f);
    float m1 = b.x - b.z;
    float m2 = b.y - b.w;
    float y = clamp((m2 - z * m1) / gn_msm_nonzero(m1 - z * m0), -1.0f, 1.0f);
    float before = -(b.z - (1.0f + z + y) * b.y + (z + y + z * y) * b.x - z * y) /
                   gn_msm_nonzero(2.0f * (1.0f + z) * (1.0f + y));
    float between = (m1 - z * m0) / gn_msm_nonzero((1.0f - y * y) * (y - z));
    GN_EXPECT(gn_finite(before) && gn_finite(between));
    return clamp(before + (y < z ? between : 0.0f), 0.0f, 1.0f);
}

// The most light that the moments allow a receiver at `depth`.
GN_FN float gn_msm_visible(vec4 stored, float depth, GnMsmParams params) {
    vec4 b = params.format == GN_MSM_UNORM16 ? gn_msm_dequantize(stored) : stored;
    b = gn_msm_biased(b, params.moment_bias);
    float z = clamp(2.0f * depth - 1.0f, -0.9999f, 0.9999f);
    float shadow = params.problem == GN_MSM_HAMBURGER ? gn_msm_hamburger(b, z) : gn_msm_hausdorff(b, z);
    return clamp((1.0f - shadow - params.bleeding) / (1.0f - params.bleeding), 0.0f, 1.0f);
}

// The share that lies before z, and its mean: of the points of the representation that has z among them.
GN_FN vec2 gn_msm_before(vec4 b, float z) {
    vec2 roots = gn_msm_roots(b, z);
    if (z <= roots.x) {
        return vec2(0.0f, z);
    }
    float first = max(gn_msm_mass(b, roots.x, z, roots.y), 0.0f);
    float second = z > roots.y ? max(gn_msm_mass(b, roots.y, z, roots.x), 0.0f) : 0.0f;
    float share = first + second;
    return vec2(clamp(share, 0.0f, 1.0f), (first * roots.x + second * roots.y) / max(share, 1.0e-6f));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// What the receiver's plane rises, in depth, from the middle of the blurred and filtered kernel to its corner.
float gn_msm_ramp(GnProjected projected, vec2 ddx_ts, vec2 ddy_ts, GnMsmParams params) {
    float blur = params.prefilter.blur == GN_BLUR_NONE ? 0.5 : float(params.prefilter.radius) + 0.5;
    vec2 half_ts = max(0.5 * (abs(ddx_ts) + abs(ddy_ts)), vec2(blur * projected.texel_ts));
    return dot(abs(projected.plane_slope), half_ts);
}

vec2 gn_msm_blockers(GnLookup at, sampler2DArray moments, vec2 ddx_ts, vec2 ddy_ts, GnMsmParams params) {
    GnProjected projected = at.projected;
    vec4 stored = gn_map_mean(moments, projected, projected.layer, ddx_ts, ddy_ts);
    vec4 b = gn_msm_biased(params.format == GN_MSM_UNORM16 ? gn_msm_dequantize(stored) : stored, params.moment_bias);
    float bias = params.ramp * gn_msm_ramp(projected, ddx_ts, ddy_ts, params) + params.depth_bias / projected.metres_per_depth;
    vec2 found = gn_msm_before(b, clamp(2.0 * (projected.depth - bias) - 1.0, -0.9999, 0.9999));
    return vec2(found.x, clamp(0.5 + 0.5 * found.y, 0.0, 1.0));
}

float gn_msm_visibility(GnLookup at, sampler2DArray moments, vec2 ddx_ts, vec2 ddy_ts, GnMsmParams params) {
    GnProjected projected = at.projected;
    vec4 stored = gn_map_mean(moments, projected, projected.layer, ddx_ts, ddy_ts);
    float bias = params.ramp * gn_msm_ramp(projected, ddx_ts, ddy_ts, params);
    return gn_msm_visible(stored, projected.depth - bias - params.depth_bias / projected.metres_per_depth, params);
}

#endif
#endif
