// SPDX-License-Identifier: MIT
// A search and a filter that only fetch: as many texels as `pcss` reads, in such places.
#ifndef GN_TESTS_PERFORMANCE_FETCH_PCSS_GLSL
#define GN_TESTS_PERFORMANCE_FETCH_PCSS_GLSL

#include "shadow/lookup/pcss/pcss.glsl"

// The sum of what `count` points of the light see.
float gn_fetch_points(GnLookup at, sampler2DArray depth, bool square, GnExtentKernel kernel, GnExtentWiden widen, int count, float noise) {
    GnExtentPoints points = gn_extent_points(square, count, noise);
    vec2 last_ts = at.projected.bounds_ts.zw - 0.5 * at.projected.texel_ts;
    float sum = 0.0;
    for (int i = 0; i < count; ++i) {
        vec2 tap_ts = gn_extent_tap_ts(at, kernel, widen, gn_extent_next(points));
        ivec2 texel = ivec2(floor(clamp(tap_ts, at.projected.bounds_ts.xy, last_ts) / at.projected.texel_ts));
        sum += texelFetch(depth, ivec3(texel, at.projected.layer), 0).r;
    }
    return sum;
}

float gn_fetch_pcss_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnPcssParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnExtentMetres metres = gn_extent_metres_of(at);
    float noise = gn_pcss_noise(at.receiver, params);
    GnExtentRegion region = gn_extent_region(at, pyramid, half_light, metres, params.least, params.early_out != 0);
    if (region.visibility >= 0.0) {
        return region.visibility;
    }
    float least_ts = params.least * at.projected.texel_ts;
    GnExtentKernel kernel = gn_extent_kernel(at, half_light, region.spread);
    GnExtentWiden widen = gn_extent_widen(kernel, least_ts, 0.0);
    float mean = gn_fetch_points(at, depth, half_light.square, kernel, widen, params.search_taps, noise) / float(params.search_taps);
    float spread = gn_extent_spread_at(at, region.receiver, gn_extent_distance(metres, at.view, at.projected.uv_ts, mean));
    kernel = gn_extent_kernel(at, half_light, spread);
    widen = gn_extent_widen(kernel, 0.0, least_ts);
    return gn_fetch_points(at, depth, half_light.square, kernel, widen, params.taps, noise) / float(params.taps);
}

#endif
