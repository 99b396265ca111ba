// SPDX-License-Identifier: MIT
// Occlusion textures: the scene in slices parallel to the light, each flattened onto its bottom; of each the share of the light that
// it hides is a mean over the part of it that the receiver sees before the light.
// Based on: Eisemann, Decoret. Plausible Image Based Soft Shadows Using Occlusion Textures. SIBGRAPI 2006. [ED06]
// Stands on: shadow/map/sums (the mean of a rectangle of texels)
// Departs from it: that part is cut into cells, so that it may be a disc, and turned against the map.
#ifndef GN_SHADOW_LOOKUP_OCCLUSION_TEXTURES_GLSL
#define GN_SHADOW_LOOKUP_OCCLUSION_TEXTURES_GLSL

#include "shadow/lookup/occlusion_textures/occlusion_textures.h"
#include "shadow/lookup/pcss/pcss_tap.glsl"
#include "shadow/map/sums.glsl"
#include "shadow/receiver/fusion.glsl"
#include "shadow/receiver/map_mean.glsl"
#include "shadow/receiver/slices.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The middle of cell i of n x n of the light, in [-1,1]^2 or within the unit disc.
GN_FN vec2 gn_occlusion_cell(bool square, int i, int n) {
    if (!square) {
        return gn_vogel(i, n * n, 0.0f);
    }
    return (vec2(float(i % n), float(i / n)) + 0.5f) * (2.0f / float(n)) - 1.0f;
}

// The side of a cell, in halves of the light's extent: cells are as large together as the light.
GN_FN float gn_occlusion_side(bool square, int n) { return (square ? 2.0f : 1.7724539f) / float(n); }

// How many squares of side 2^l stand beside each other over a length of `texels`, the first and the last within it.
GN_FN int gn_occlusion_squares(float texels, float square) { return clamp(int(ceil(texels / square - 1.0e-3f)), 1, 8); }

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// The mean of one slice over a rectangle around `middle_ts`. Squares of an N-buffer overlap where the sides are no powers of two.
float gn_occlusion_squares_mean(GnLookup at, sampler2DArray slices, int layer, int channel, vec2 middle_ts, vec2 side_ts) {
    vec2 size = vec2(textureSize(slices, 0).xy);
    int levels = findMSB(int(size.x)) + 1;
    vec2 side = max(side_ts * size, vec2(1.0));
    int level = clamp(int(floor(log2(min(side.x, side.y)) + 1.0e-3)), 0, levels - 1);
    float square = exp2(float(level));
    ivec2 count = ivec2(gn_occlusion_squares(side.x, square), gn_occlusion_squares(side.y, square));
    vec2 step = (side - square) / max(vec2(count) - 1.0, vec2(1.0));
    vec2 first = middle_ts * size - 0.5 * (square + step * (vec2(count) - 1.0));
    vec2 least = at.projected.bounds_ts.xy * size;
    vec2 most = max(at.projected.bounds_ts.zw * size - square, least);
    float sum = 0.0;
    for (int i = 0; i < count.x * count.y; ++i) {
        vec2 start = clamp(first + step * vec2(i % count.x, i / count.x), least, most);
        sum += textureLod(slices, vec3((start + 0.5) / size, layer * levels + level), 0.0)[channel];
    }
    return sum / float(count.x * count.y);
}

// What a table of sums holds before a place between texels.
float gn_occlusion_before(sampler2DArray slices, int layer, int channel, vec2 place) {
    ivec2 a = ivec2(floor(place));
    ivec2 b = min(a + 1, textureSize(slices, 0).xy);
    vec2 t = place - vec2(a);
    float aa = gn_sat_fetch(slices, a, layer)[channel];
    float ba = gn_sat_fetch(slices, ivec2(b.x, a.y), layer)[channel];
    float ab = gn_sat_fetch(slices, ivec2(a.x, b.y), layer)[channel];
    float bb = gn_sat_fetch(slices, b, layer)[channel];
    return mix(mix(aa, ba, t.x), mix(ab, bb, t.x), t.y);
}

float gn_occlusion_table_mean(GnLookup at, sampler2DArray slices, int layer, int channel, vec2 middle_ts, vec2 side_ts) {
    vec2 size = vec2(textureSize(slices, 0).xy);
    vec2 side = max(side_ts * size, vec2(1.0));
    vec2 least = at.projected.bounds_ts.xy * size;
    vec2 most = at.projected.bounds_ts.zw * size;
    vec2 a = clamp(middle_ts * size - 0.5 * side, least, most - 1.0);
    vec2 b = clamp(middle_ts * size + 0.5 * side, a + 1.0, most);
    float sum = gn_occlusion_before(slices, layer, channel, b) - gn_occlusion_before(slices, layer, channel, vec2(a.x, b.y)) -
                gn_occlusion_before(slices, layer, channel, vec2(b.x, a.y)) + gn_occlusion_before(slices, layer, channel, a);
    return clamp(sum / ((b.x - a.x) * (b.y - a.y)) + gn_sat_centre()[channel], 0.0, 1.0);
}

float gn_occlusion_mips_mean(GnLookup at, sampler2DArray slices, int layer, int channel, vec2 middle_ts, vec2 side_ts) {
    GnProjected there = at.projected;
    there.uv_ts = middle_ts;
    return gn_map_mean(slices, there, layer, vec2(side_ts.x, 0.0), vec2(0.0, side_ts.y))[channel];
}

// The share of the light that slice k hides, through its bottom at `spread`.
float gn_occlusion_hidden(GnLookup at, sampler2DArray slices, GnExtentLight half_light, float spread, int k,
                          GnOcclusionTexturesParams params) {
    float half_side = 0.5 * gn_occlusion_side(half_light.square, params.cells);
    int layer = at.projected.layer * ((params.slices + 3) / 4) + k / 4;
    int channel = k & 3;
    int cells = params.cells * params.cells;
    GnExtentKernel kernel = gn_extent_kernel(at, half_light, spread);
    float hidden = 0.0;
    for (int i = 0; i < cells; ++i) {
        vec2 q = gn_occlusion_cell(half_light.square, i, params.cells);
        // The map may look askew: the middles of the cell's sides say where it is and how large.
        vec2 left_ts = gn_extent_way(kernel, q - vec2(half_side, 0.0));
        vec2 right_ts = gn_extent_way(kernel, q + vec2(half_side, 0.0));
        vec2 down_ts = gn_extent_way(kernel, q - vec2(0.0, half_side));
        vec2 up_ts = gn_extent_way(kernel, q + vec2(0.0, half_side));
        vec2 middle_ts = at.projected.uv_ts + 0.25 * (left_ts + right_ts + down_ts + up_ts);
        vec2 side_ts = sqrt((right_ts - left_ts) * (right_ts - left_ts) + (up_ts - down_ts) * (up_ts - down_ts));
        hidden += params.filter_by == GN_OCCLUSION_N_BUFFERS
                      ? gn_occlusion_squares_mean(at, slices, layer, channel, middle_ts, side_ts)
                  : params.filter_by == GN_OCCLUSION_SUMS
                      ? gn_occlusion_table_mean(at, slices, layer, channel, middle_ts, side_ts)
                      : gn_occlusion_mips_mean(at, slices, layer, channel, middle_ts, side_ts);
    }
    return hidden / float(cells);
}

float gn_occlusion_textures_visibility(GnLookup at, sampler2DArray depth, sampler2DArray slices, GnOcclusionTexturesParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    if (half_light.right_ws == vec3(0.0) && half_light.up_ws == vec3(0.0)) {
        return gn_pcss_tap(at, depth, gn_extent_metres_of(at), at.projected.uv_ts).lit ? 1.0 : 0.0;
    }
    float end = gn_slices_end(at.light, at.view);
    float receiver = gn_slices_metres(at.light, at.view, at.projected.uv_ts, at.projected.depth);
    GnFused fused = gn_unfused();
    // What lies in the receiver's own slice does not count: its bottom is behind the receiver.
    for (int k = 0; k < params.slices && gn_slice_bottom(k, params.slices, end) < receiver; ++k) {
        float spread = gn_extent_spread_at(at, receiver, gn_slice_bottom(k, params.slices, end));
        fused = gn_fuse(fused, gn_occlusion_hidden(at, slices, half_light, spread, k, params));
    }
    return 1.0 - gn_fused(fused, params.fusion);
}
#endif

#endif
