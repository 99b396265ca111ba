// SPDX-License-Identifier: MIT
// Convolution shadow maps: the shadow test as a truncated Fourier series, a sum of products of map and receiver.
// Based on: Annen, Mertens, Bekaert, Seidel, Kautz. Convolution Shadow Maps. EGSR 2007. [AMB+07]
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia 2009. [EASW09]
// Departs from it: depth takes less than half of the series' period, so that the far end does not wrap into light.
#ifndef GN_SHADOW_MAP_CONVOLUTION_GLSL
#define GN_SHADOW_MAP_CONVOLUTION_GLSL

#include "shadow/map/convolution/convolution.h"
#include "shadow/receiver/map_mean.glsl"
#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Frequency of term k = 1, 2, ...: odd multiples of pi.
GN_FN float gn_convolution_frequency(int k) { return 3.14159265f * float(2 * k - 1); }

// Texels of four bytes that `terms` terms need: two terms in each.
GN_FN int gn_convolution_groups(int terms) { return (terms + 1) / 2; }

// What group g stores of a depth: cosine and sine of terms 2 g + 1 and 2 g + 2, moved into [0,1].
GN_FN vec4 gn_convolution_encode(float depth, int group, float span) {
    float a = gn_convolution_frequency(2 * group + 1) * depth * span;
    float b = gn_convolution_frequency(2 * group + 2) * depth * span;
    return 0.5f + 0.5f * vec4(cos(a), sin(a), cos(b), sin(b));
}

// Contribution of term k of `terms` to the lit share, [EASW09] eq. 4.6: both products are the sine of a difference.
// [AMB+07] 4.2: high terms are attenuated against ringing.
GN_FN float gn_convolution_term(vec2 basis, float receiver, int k, GnConvolutionParams params) {
    float c = gn_convolution_frequency(k);
    float ratio = float(k) / float(params.terms);
    float weight = 2.0f / c * exp(-params.attenuation * ratio * ratio);
    vec2 mean = 2.0f * basis - 1.0f;
    return weight * (cos(c * receiver) * mean.y - sin(c * receiver) * mean.x);
}

// Both terms of a group.
GN_FN float gn_convolution_group(vec4 stored, float receiver, int group, GnConvolutionParams params) {
    float sum = gn_convolution_term(vec2(stored.x, stored.y), receiver, 2 * group + 1, params);
    if (2 * group + 2 <= params.terms) {
        sum += gn_convolution_term(vec2(stored.z, stored.w), receiver, 2 * group + 2, params);
    }
    return sum;
}

// The receiver within the series: moved towards the light by `offset` times the half width of the truncated step, which
// is 1 / (2 terms) of the period's half.
GN_FN float gn_convolution_receiver(float depth, GnConvolutionParams params) {
    return clamp(depth, 0.0f, 1.0f) * params.span - params.offset / (2.0f * float(params.terms));
}

// [EASW09] 4.2.3: the value is scaled and clamped. It is 1/2 on the step itself, which a scale of 2 makes lit.
GN_FN float gn_convolution_step(float sum, float scale) { return clamp(scale * (0.5f + sum), 0.0f, 1.0f); }

#ifdef __cplusplus
}  // namespace gn::glsl
#else

float gn_convolution_visibility(GnLookup at, sampler2DArray waves, vec2 ddx_ts, vec2 ddy_ts, GnConvolutionParams params) {
    GnProjected projected = at.projected;
    int groups = gn_convolution_groups(params.terms);
    float receiver = gn_convolution_receiver(projected.depth, params);
    float sum = 0.0;
    for (int group = 0; group < groups; ++group) {
        vec4 mean = gn_map_mean(waves, projected, projected.layer * groups + group, ddx_ts, ddy_ts);
        sum += gn_convolution_group(mean, receiver, group, params);
    }
    GN_EXPECT(gn_finite(sum));
    return gn_convolution_step(sum, params.scale);
}

#endif
#endif
