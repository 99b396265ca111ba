// SPDX-License-Identifier: MIT
// Exponential shadow maps: a comparison becomes a product of exponentials, and a filtered comparison a filtered map.
// Based on: Annen, Mertens, Seidel, Flerackers, Kautz. Exponential Shadow Maps. GI 2008. [AMS+08]
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia 2009. [EASW09]
// Departs from it: the fallback compares with the receiver's plane, texel by texel, and does not clamp exponentials.
#ifndef GN_SHADOW_MAP_ESM_GLSL
#define GN_SHADOW_MAP_ESM_GLSL

#include "shadow/map/esm/esm.h"
#include "shadow/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What a texel stores; exp(85) of the greatest exponent is below 3.4e38 even when four samples are added.
GN_FN float gn_esm_encode(float depth, float c) { return exp(c * depth); }

// [EASW09] eq. 4.7: the mean of exp(-c (d - z)); above one where the kernel holds depths beyond the receiver.
GN_FN float gn_esm_product(float mean, float depth, float c) { return exp(-c * clamp(depth, 0.0f, 1.0f)) * mean; }

// [EASW09] 4.2.4: the mean exceeds one, so some depth lies beyond the receiver and the exponential is no step.
GN_FN bool gn_esm_fails(float product, float epsilon) { return product > 1.0f + epsilon; }

// Weight of a cell of the fallback's grid: how much of [start, start + size) it covers.
GN_FN float gn_esm_cover(float cell, float step, float start, float size) {
    return max(0.0f, min(cell + step, start + size) - max(cell, start));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Percentage-closer filtering of the box that blur and footprint cover together, at most 17 x 17 texels of it.
float gn_esm_pcf(sampler2DArray raw, GnProjected projected, vec2 footprint_ts, GnEsmParams params) {
    GnBias plane;
    plane.receiver_plane = 1;
    vec2 t = projected.uv_ts / projected.texel_ts;
    float blur = params.prefilter.blur == GN_BLUR_NONE ? 1.0 : 2.0 * float(params.prefilter.radius) + 1.0;
    vec2 size = max(vec2(blur), footprint_ts / projected.texel_ts);
    vec2 step = max(vec2(1.0), ceil(size / 16.0));
    vec2 start = t - 0.5 * size;
    vec2 first = floor(start / step) * step;
    vec2 low = projected.bounds_ts.xy / projected.texel_ts;
    vec2 high = projected.bounds_ts.zw / projected.texel_ts - 1.0;

    float lit = 0.0;
    float total = 0.0;
    for (float y = first.y; y < start.y + size.y; y += step.y) {
        float weight_y = gn_esm_cover(y, step.y, start.y, size.y);
        for (float x = first.x; x < start.x + size.x; x += step.x) {
            float weight = weight_y * gn_esm_cover(x, step.x, start.x, size.x);
            vec2 texel = clamp(floor(vec2(x, y) + 0.5 * step), low, high);
            float stored = texelFetch(raw, ivec3(ivec2(texel), projected.layer), 0).r;
            float depth = gn_depth_at(projected, (texel + 0.5) * projected.texel_ts, plane);
            lit += depth <= log(stored) / params.exponent ? weight : 0.0;
            total += weight;
        }
    }
    return total > 0.0 ? lit / total : 1.0;
}

// `extra` is the map before any blur.
float gn_esm_visibility(sampler2DArray map, sampler2DArray extra, GnProjected projected, vec2 ddx_ts, vec2 ddy_ts,
                        GnEsmParams params) {
    float mean = textureGrad(map, vec3(projected.uv_ts, projected.layer), ddx_ts, ddy_ts).r;
    float product = gn_esm_product(mean, projected.depth, params.exponent);
    GN_EXPECT(gn_finite(product) && product >= 0.0);
    if (params.fallback != 0 && gn_esm_fails(product, params.epsilon)) {
        return gn_esm_pcf(extra, projected, abs(ddx_ts) + abs(ddy_ts), params);
    }
    return min(product, 1.0);
}

#endif
#endif
