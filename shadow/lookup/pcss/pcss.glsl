// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows: search for what hides the light, guess the penumbra from how far away it is, filter as wide.
// Based on: Fernando. Percentage-Closer Soft Shadows. SIGGRAPH Sketches 2005. [Fer05]
// Penumbrae and what the search assumes: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia
// Courses 2009. [EASW09], 5.2.2.
// Departs from them: taps are points of the light itself, in its own shape and place, as the receiver sees them through a
// plane at the blockers' depth; a pyramid of least and greatest depths narrows the search and ends it early.
#ifndef GN_SHADOW_LOOKUP_PCSS_GLSL
#define GN_SHADOW_LOOKUP_PCSS_GLSL

#include "shadow/lookup/pcss/pcss.h"
#include "shadow/lookup/pcss/pcss_tap.glsl"
#include "shadow/receiver/bilinear_tap.glsl"
#include "shadow/receiver/light_plane.glsl"
#include "shadow/receiver/confidence.glsl"

#ifndef __cplusplus

// A host may fix when it compiles what the filter's taps compare.
//   #define GN_PCSS_TAP GN_PCSS_ONE_TEXEL
#ifndef GN_PCSS_TAP
#define GN_PCSS_TAP params.tap
#endif

// Planes before all depths of blocks, for early-outs on slanted surfaces:
//   #define GN_PCSS_PLANES
#ifdef GN_PCSS_PLANES
#define GN_PCSS_MAPS sampler2DArray depth, sampler2DArray pyramid, sampler2DArray planes
#define GN_PCSS_THESE depth, pyramid, planes
#else
#define GN_PCSS_MAPS sampler2DArray depth, sampler2DArray pyramid
#define GN_PCSS_THESE depth, pyramid
#endif

// What turns the taps from pixel to pixel, or from place to place on the surface; there a pixel's size is the mean of its sides.
float gn_pcss_noise(GnReceiver receiver, GnPcssParams params) {
    if (params.noise == GN_PCSS_OF_PIXEL) {
        return gn_gradient_noise(receiver.p_ss);
    }
    return gn_surface_noise(receiver.p_ws, receiver.n_ws, sqrt(length(receiver.ddx_ws) * length(receiver.ddy_ws)));
}

struct GnPcssFound {
    float visibility;  // 0 or 1 where the extremes decide or nothing was found, else -1
    float receiver;    // metres along the axis
    float blocker;     // their mean, or the nearest
};

// Where what hides the light can lie. With planes they are asked between both steps that narrow the region, and its extremes not
// once more after them.
GnExtentRegion gn_pcss_where(GnLookup at, GN_PCSS_MAPS, GnExtentLight half_light, GnPcssParams params) {
    GnExtentMetres metres = gn_extent_metres_of(at);
    bool early_out = params.early_out != 0;
    // Half a texel farther a tap reads the texel beside the one that it falls into.
    float least = params.least + (GN_PCSS_TAP == GN_PCSS_FOUR_TEXELS ? 0.5 : 0.0);
#ifdef GN_PCSS_PLANES
    GnExtentKernel one = gn_extent_kernel(at, half_light, 1.0);
    GnExtentRegion region = gn_extent_anywhere(at, pyramid, metres);
    region = gn_extent_narrowed(at, pyramid, half_light, one, metres, region, least, early_out);
    if (region.visibility < 0.0 && early_out && gn_extent_all_before(at, planes, half_light, one, region, least)) {
        region.visibility = 1.0;
    }
    if (region.visibility < 0.0) {
        region = gn_extent_narrowed(at, pyramid, half_light, one, metres, region, least, early_out);
    }
    return region;
#else
    return gn_extent_region(at, pyramid, half_light, metres, least, early_out);
#endif
}

GnPcssFound gn_pcss_search(GnLookup at, GN_PCSS_MAPS, GnExtentLight half_light,
                           GnPcssParams params, float noise) {
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnExtentRegion region = gn_pcss_where(at, GN_PCSS_THESE, half_light, params);
    GnPcssFound result = GnPcssFound(region.visibility, region.receiver, region.receiver);
    if (result.visibility >= 0.0) {
        return result;
    }

    GnExtentKernel kernel = gn_extent_kernel(at, half_light, region.spread);
    GnExtentWiden widen = gn_extent_widen(kernel, params.least * at.projected.texel_ts, 0.0);
    GnExtentPoints points = gn_extent_points(half_light.square, params.search_taps, noise);
    float sum = 0.0;
    float count = 0.0;
    float nearest = result.receiver;
    for (int i = 0; i < params.search_taps; ++i) {
        GnPcssTap tap = gn_pcss_tap(at, depth, metres, gn_extent_tap_ts(at, kernel, widen, gn_extent_next(points)));
        if (!tap.lit) {
            sum += tap.distance;
            count += 1.0;
            nearest = min(nearest, tap.distance);
        }
    }
    if (count == 0.0) {
        result.visibility = 1.0;
        return result;
    }
    result.blocker = clamp(params.blocker == GN_PCSS_NEAREST ? nearest : sum / count, 0.0, result.receiver);
    return result;
}

// The share of a tap of the filter that is lit.
float gn_pcss_lit(GnLookup at, sampler2DArray depth, GnExtentMetres metres, GnPcssParams params, vec2 tap_ts) {
    return GN_PCSS_TAP == GN_PCSS_FOUR_TEXELS ? gn_bilinear_tap(depth, at, tap_ts)
                                              : gn_pcss_tap(at, depth, metres, tap_ts).lit ? 1.0 : 0.0;
}

float gn_pcss_visibility(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    float noise = gn_pcss_noise(at.receiver, params);
    GnPcssFound found = gn_pcss_search(at, GN_PCSS_THESE, half_light, params, noise);
    if (found.visibility >= 0.0) {
        return found.visibility;
    }
    float spread = gn_extent_spread_at(at, found.receiver, found.blocker);
    float least_ts = params.least * at.projected.texel_ts;
    GnExtentKernel kernel = gn_extent_kernel(at, half_light, spread);
    GnExtentWiden widen = gn_extent_widen(kernel, 0.0, least_ts);
    vec2 reach_ts = gn_extent_reach(kernel, half_light.square);
    float width = max(max(reach_ts.x, reach_ts.y), least_ts) / at.projected.texel_ts;
    int taps = clamp(int(ceil(params.density * width)), min(4, params.taps), params.taps);
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnExtentPoints points = gn_extent_points(half_light.square, taps, noise);
    float lit = 0.0;
    for (int i = 0; i < taps; ++i) {
        lit += gn_pcss_lit(at, depth, metres, params, gn_extent_tap_ts(at, kernel, widen, gn_extent_next(points)));
    }
    return lit / float(taps);
}

// Why a search ended: 1 all of the light is seen, 2 none of it, 3 the texels had to be read.
float gn_pcss_search_class(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    GnExtentRegion region = gn_pcss_where(at, GN_PCSS_THESE, gn_extent_light(at.light, at.receiver.p_ws), params);
    return region.visibility == 1.0 ? 1.0 : region.visibility == 0.0 ? 2.0 : 3.0;
}

// Metres along the axis from the receiver to what hides the light from it; 0 where nothing does.
float gn_pcss_blocker_distance(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    params.early_out = 0;
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnPcssFound found = gn_pcss_search(at, GN_PCSS_THESE, half_light, params, gn_pcss_noise(at.receiver, params));
    return found.visibility >= 0.0 ? 0.0 : found.receiver - found.blocker;
}

// Metres across the penumbra, where it lies across the axis; 0 where nothing hides the light.
float gn_pcss_penumbra_width(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    params.early_out = 0;
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnPcssFound found = gn_pcss_search(at, GN_PCSS_THESE, half_light, params, gn_pcss_noise(at.receiver, params));
    return found.visibility >= 0.0 ? 0.0 : gn_extent_width(half_light, gn_extent_spread_at(at, found.receiver, found.blocker));
}

// Half the shorter side of the filter on the light's plane, before `least` widens it; 0 where all of the light is seen or none.
float gn_pcss_filter_radius(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnPcssFound found = gn_pcss_search(at, GN_PCSS_THESE, half_light, params, gn_pcss_noise(at.receiver, params));
    if (found.visibility >= 0.0) {
        return 0.0;
    }
    float spread = gn_extent_spread_at(at, found.receiver, found.blocker);
    vec4 axes_ts = gn_extent_axes(gn_extent_kernel(at, half_light, spread));
    float right = length(gn_on_light_plane(at.view, axes_ts.xy));
    float up = length(gn_on_light_plane(at.view, axes_ts.zw));
    return max(min(right, up), 1.0e-30);
}

// How near the texel's centre lies, and how far around the sample casters change its V.
float gn_pcss_confidence(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) { return gn_confidence(at.projected); }
float gn_pcss_kernel_reach(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) { return gn_kernel_reach(at.projected, at.bias); }
#endif

#endif
