// SPDX-License-Identifier: MIT
// Convolution soft shadow maps: the mean depth of what hides the light, too, as a sum of products of map and receiver.
// Based on: Annen, Dong, Mertens, Bekaert, Seidel, Kautz. Real-Time, All-Frequency Shadows in Dynamic Scenes. SIGGRAPH 2008.
// [ADM+08]
// The two series: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09],
// 4.2.3 and 5.2.2.3.
// Departs from them: the step is 1/2 where it stands, which would count half of the receiver itself among its blockers; it is moved
// towards the light for the search as it is for the shadow.
#ifndef GN_SHADOW_MAP_CSSM_GLSL
#define GN_SHADOW_MAP_CSSM_GLSL

#include "shadow/map/convolution/convolution.glsl"
#include "shadow/map/cssm/cssm.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The series' own parameters, moved by `offset` half widths of its step.
GN_FN GnConvolutionParams gn_cssm_series(GnCssmParams params, float offset) {
    GnConvolutionParams series;
    series.terms = params.terms;
    series.attenuation = params.attenuation;
    series.offset = offset;
    series.scale = 1.0f;
    series.span = params.span;
    return series;
}

// Textures of four numbers that hold z cos and z sin of every term, and z itself.
GN_FN int gn_cssm_groups(int terms) { return gn_convolution_groups(terms) + 1; }

// What group g stores of a depth: like the waves, times the depth; the last the depth.
GN_FN vec4 gn_cssm_encode(float depth, int group, int terms, float span) {
    float z = depth * span;
    if (group == gn_convolution_groups(terms)) {
        return vec4(z, 0.0f, 0.0f, 0.0f);
    }
    vec4 waves = 2.0f * gn_convolution_encode(depth, group, span) - 1.0f;
    return 0.5f + 0.5f * z * waves;
}

// How much of the light is hidden, by the sum of the waves' terms; and its mean depth, by that of the depth-waves' terms and the
// mean of z: the step's complement, times z. [EASW09] 5.2.2.3
GN_FN vec2 gn_cssm_found(float waves, float depth_waves, float mean, float span) {
    float hidden = 0.5f - waves;
    float sum = 0.5f * mean - depth_waves;
    return vec2(clamp(hidden, 0.0f, 1.0f), hidden > 1.0e-4f ? sum / hidden / span : 1.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

float gn_cssm_visibility(GnLookup at, sampler2DArray waves, sampler2DArray depth_waves, vec2 ddx_ts, vec2 ddy_ts, GnCssmParams params) {
    return gn_convolution_visibility(at, waves, ddx_ts, ddy_ts, gn_cssm_series(params, params.offset));
}

// The share of a footprint that hides the light from the receiver, and its mean depth.
vec2 gn_cssm_blockers(GnLookup at, sampler2DArray waves, sampler2DArray depth_waves, vec2 ddx_ts, vec2 ddy_ts, GnCssmParams params) {
    GnProjected projected = at.projected;
    GnConvolutionParams series = gn_cssm_series(params, params.search_offset);
    float receiver = gn_convolution_receiver(projected.depth, series);
    int groups = gn_convolution_groups(params.terms);
    float sum = 0.0;
    float depth_sum = 0.0;
    for (int group = 0; group < groups; ++group) {
        vec4 mean = gn_map_mean(waves, projected, projected.layer * groups + group, ddx_ts, ddy_ts);
        sum += gn_convolution_group(mean, receiver, group, series);
        mean = gn_map_mean(depth_waves, projected, projected.layer * (groups + 1) + group, ddx_ts, ddy_ts);
        depth_sum += gn_convolution_group(mean, receiver, group, series);
    }
    float mean = gn_map_mean(depth_waves, projected, projected.layer * (groups + 1) + groups, ddx_ts, ddy_ts).x;
    return gn_cssm_found(sum, depth_sum, mean, params.span);
}

#endif
#endif
