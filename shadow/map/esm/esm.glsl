// SPDX-License-Identifier: MIT
// Exponential shadow maps: a comparison becomes a product of exponentials, and a filtered comparison a filtered map.
// Based on: Annen, Mertens, Seidel, Flerackers, Kautz. Exponential Shadow Maps. GI 2008. [AMS+08]
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia 2009. [EASW09]
// Departs from it: the fallback compares depths with the receiver's plane, texel by texel, and clamps no exponentials.
#ifndef GN_SHADOW_MAP_ESM_GLSL
#define GN_SHADOW_MAP_ESM_GLSL

#include "shadow/receiver/map_range.glsl"
#include "shadow/map/esm/esm.h"
#include "shadow/receiver/map_mean.glsl"
#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What a texel stores; exp(85) of the greatest exponent is below 3.4e38 even when four samples are added.
GN_FN float gn_esm_encode(float depth, float c) { return exp(c * depth); }

// [EASW09] eq. 4.7: the mean of exp(-c (d - z)); above one where the kernel holds depths beyond the receiver.
GN_FN float gn_esm_product(float mean, float depth, float c) { return exp(-c * clamp(depth, 0.0f, 1.0f)) * mean; }

// [EASW09] 4.2.4: the value exceeds one, so some depth lies beyond the receiver and the exponential is no step.
GN_FN bool gn_esm_fails(float product, float epsilon) { return product > 1.0f + epsilon; }

// A bias b of depth multiplies the mean by exp(c b). It is applied to the product instead, as a share: depth moves by b / c.
GN_FN float gn_esm_receiver(GnProjected projected, float c) {
    return projected.depth + projected.bias * (1.0f - 1.0f / max(c, 1.0f));
}

// One side of the kernel: where it starts and how long it is, in cells of the finest level, `unit` of which are a texel.
struct GnEsmKernel {
    vec2 start;
    vec2 size;
    float unit;
    int blur;
};

// Weight of the discrete Gaussian that the map was blurred with: sigma is half its reach, and it is cut there.
GN_FN float gn_esm_gaussian(float texels, float reach) {
    float x = reach > 0.0f ? 2.0f * texels / reach : 0.0f;
    return abs(texels) <= reach + 0.001f ? exp(-0.5f * x * x) : 0.0f;
}

// Weight of the cells [cell, cell + step) of the kernel [start, start + size), along one axis. A box covers them; a Gaussian
// of whole texels that is fetched bilinearly weighs a texel in proportion between its two nearest weights.
GN_FN float gn_esm_weight(float cell, float step, float start, float size, float unit, int blur) {
    if (blur != GN_BLUR_GAUSSIAN) {
        return max(0.0f, min(cell + step, start + size) - max(cell, start));
    }
    float reach = 0.5f * (size / unit - 1.0f);
    float texels = (cell + 0.5f * step - (start + 0.5f * size)) / unit;
    if (step > 1.0f) {
        return step * gn_esm_gaussian(texels, reach);
    }
    float below = floor(texels);
    return mix(gn_esm_gaussian(below, reach), gn_esm_gaussian(below + 1.0f, reach), texels - below);
}

// The level at which a kernel is at most 16 cells long.
GN_FN int gn_esm_level(vec2 size, int levels) {
    int level = 0;
    while (level < levels - 1 && max(size.x, size.y) > 16.0f * float(1 << level)) {
        ++level;
    }
    return level;
}

// Share of a cell that lies at or beyond a depth, where only its least and greatest depths are known.
GN_FN float gn_esm_between(vec2 range, float depth) {
    return depth <= range.x ? 1.0f : (depth > range.y ? 0.0f : (range.y - depth) / max(range.y - range.x, 1.0e-9f));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Least and greatest depth of a cell of a level, within the view's rectangle; `bounds` in cells of the finest level.
vec2 gn_esm_range(sampler2DArray ranges, vec2 cell, int level, int layer, vec4 bounds) {
    ivec2 texel = ivec2(clamp(cell, bounds.xy, bounds.zw)) >> level;
    return texelFetch(ranges, ivec3(min(texel, max(textureSize(ranges, 0).xy >> level, ivec2(1)) - 1), layer), level).xy;
}

// The lit share of one cell whose depths lie to both sides of the receiver's plane: of its parts three levels down, which are
// texels in kernels of up to 128, and those compared one by one.
float gn_esm_parts(sampler2DArray ranges, GnProjected projected, GnEsmKernel kernel, vec2 cell, int level, vec4 bounds,
                   GnBias plane) {
    int finer = max(level - 3, 0);
    float step = float(1 << finer);
    float cell_ts = projected.texel_ts / kernel.unit;
    vec2 end = cell + float(1 << level);
    float lit = 0.0;
    float total = 0.0;
    for (float y = cell.y; y < end.y; y += step) {
        float weight_y = gn_esm_weight(y, step, kernel.start.y, kernel.size.y, kernel.unit, kernel.blur);
        for (float x = cell.x; x < end.x; x += step) {
            float weight = weight_y * gn_esm_weight(x, step, kernel.start.x, kernel.size.x, kernel.unit, kernel.blur);
            vec2 middle = clamp(vec2(x, y), bounds.xy, bounds.zw) + 0.5 * step;
            float depth = gn_depth_at(projected, middle * cell_ts, plane);
            lit += weight * gn_esm_between(gn_esm_range(ranges, vec2(x, y), finer, projected.layer, bounds), depth);
            total += weight;
        }
    }
    return total > 0.0 ? lit / total : 0.0;
}

// What blur and footprint cover together. A texel with four samples is four cells.
GnEsmKernel gn_esm_kernel(GnProjected projected, vec2 footprint_ts, GnEsmParams params) {
    GnEsmKernel kernel;
    kernel.unit = params.samples > 1 ? 2.0 : 1.0;
    kernel.blur = params.prefilter.blur;
    float blur = params.prefilter.blur == GN_BLUR_NONE ? 1.0 : 2.0 * float(params.prefilter.radius) + 1.0;
    kernel.size = kernel.unit * max(vec2(blur), footprint_ts / projected.texel_ts);
    kernel.start = kernel.unit * projected.uv_ts / projected.texel_ts - 0.5 * kernel.size;
    return kernel;
}

vec4 gn_esm_bounds(GnProjected projected, GnEsmKernel kernel) {
    vec4 bounds = kernel.unit * projected.bounds_ts / projected.texel_ts;
    return vec4(bounds.xy, bounds.zw - 1.0);
}

// Percentage-closer filtering of the kernel. Cells that lie wholly before or behind the receiver's plane count at once.
float gn_esm_pcf(sampler2DArray ranges, GnProjected projected, GnEsmKernel kernel) {
    GnBias plane;
    plane.receiver_plane = 1;
    vec4 bounds = gn_esm_bounds(projected, kernel);
    int level = gn_esm_level(kernel.size, textureQueryLevels(ranges));
    float step = float(1 << level);
    float cell_ts = projected.texel_ts / kernel.unit;
    // A Gaussian's outermost texels weigh something until their neighbours' places.
    float beyond = kernel.blur == GN_BLUR_GAUSSIAN ? kernel.unit : 0.0;
    vec2 first = floor((kernel.start - beyond) / step) * step;
    vec2 end = kernel.start + kernel.size + beyond;
    float rise = level > 0 ? 0.5 * step * cell_ts * dot(abs(projected.plane_slope), vec2(1.0)) : 0.0;

    float lit = 0.0;
    float total = 0.0;
    for (float y = first.y; y < end.y; y += step) {
        float weight_y = gn_esm_weight(y, step, kernel.start.y, kernel.size.y, kernel.unit, kernel.blur);
        for (float x = first.x; x < end.x; x += step) {
            float weight = weight_y * gn_esm_weight(x, step, kernel.start.x, kernel.size.x, kernel.unit, kernel.blur);
            vec2 range = gn_esm_range(ranges, vec2(x, y), level, projected.layer, bounds);
            float depth = gn_depth_at(projected, (clamp(vec2(x, y), bounds.xy, bounds.zw) + 0.5 * step) * cell_ts, plane);
            if (depth + rise <= range.x) {
                lit += weight;
            } else if (depth - rise <= range.y) {
                lit += weight * gn_esm_parts(ranges, projected, kernel, vec2(x, y), level, bounds, plane);
            }
            total += weight;
        }
    }
    return total > 0.0 ? lit / total : 1.0;
}

// [EASW09] 4.2.4, the better classifier: the greatest depth of the filtering window.
float gn_esm_greatest(sampler2DArray ranges, GnProjected projected, GnEsmKernel kernel) {
    vec4 bounds = gn_esm_bounds(projected, kernel);
    ivec2 first = ivec2(clamp(floor(kernel.start), bounds.xy, bounds.zw));
    ivec2 last = ivec2(clamp(ceil(kernel.start + kernel.size) - 1.0, bounds.xy, bounds.zw));
    return gn_pyramid_min_max(ranges, first, last, projected.layer, textureQueryLevels(ranges)).y;
}

// `ranges` is the pyramid of depths that the fallback compares with; without fallback nothing reads it.
float gn_esm_visibility(GnLookup at, sampler2DArray exponentials, sampler2DArray ranges, vec2 ddx_ts, vec2 ddy_ts, GnEsmParams params) {
    GnProjected projected = at.projected;
    float mean = gn_map_mean(exponentials, projected, projected.layer, ddx_ts, ddy_ts).r;
    float depth = gn_esm_receiver(projected, params.exponent);
    float product = gn_esm_product(mean, depth, params.exponent);
    GN_EXPECT(gn_finite(product) && product >= 0.0);
    if (params.fallback != 0) {
        GnEsmKernel kernel = gn_esm_kernel(projected, abs(ddx_ts) + abs(ddy_ts), params);
        float most = product;
        if (params.classifier == GN_ESM_MAXIMUM) {
            float greatest = gn_esm_greatest(ranges, projected, kernel);
            most = gn_esm_product(gn_esm_encode(greatest, params.exponent), depth, params.exponent);
        }
        if (gn_esm_fails(most, params.epsilon)) {
            return gn_esm_pcf(ranges, projected, kernel);
        }
    }
    return min(product, 1.0);
}

#endif
#endif
