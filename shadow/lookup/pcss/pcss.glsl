// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows: search for what hides the light, guess the penumbra from how far away it is, filter as wide.
// Based on: Fernando. Percentage-Closer Soft Shadows. SIGGRAPH Sketches 2005. [Fer05]
// Penumbrae and what the search assumes: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia
// Courses 2009. [EASW09], 5.2.2.
// Departs from them: taps are points of the light itself, in its own shape and place, as the receiver sees them through a
// plane at the blockers' depth; a pyramid of least and greatest depths narrows the search and ends it early; rays go through the
// map where casters cage the light [ARHM00].
#ifndef GN_SHADOW_LOOKUP_PCSS_GLSL
#define GN_SHADOW_LOOKUP_PCSS_GLSL

#include "shadow/lookup/pcss/pcss.h"
#include "shadow/lookup/pcss/pcss_kernel.glsl"
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

// Rays where casters cage the light, and what they take from smrt:
//   #define GN_PCSS_RAYS
//   with #define GN_PCSS_RAY_STEPS 8
//   with #define GN_PCSS_RAYS_STEEPEST 6.0
#ifdef GN_PCSS_RAYS
#include "shadow/lookup/smrt/rays.glsl"
#endif

// What turns the taps from pixel to pixel, or from place to place on the surface; there a pixel's size is the mean of its sides.
float gn_pcss_noise(GnReceiver receiver, GnPcssParams params) {
    if (params.noise == GN_PCSS_OF_PIXEL) {
        return gn_gradient_noise(receiver.p_ss);
    }
    return gn_surface_noise(receiver.p_ws, receiver.n_ws, sqrt(length(receiver.ddx_ws) * length(receiver.ddy_ws)));
}

struct GnPcssFound {
    float visibility;  // 1 where nothing was found, of a region what it decides, else -1
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

// Whether what hides the light can stand so near to it that it has no one distance.
bool gn_pcss_caged(GnLookup at, GnExtentLight half_light, GnExtentRegion region, GnPcssParams params) {
#ifdef GN_PCSS_RAYS
    bool near = region.nearest < params.caged * max(length(half_light.right_ws), length(half_light.up_ws));
    return GN_VIEW_KIND != 0 && at.view.eye_ws.w > 0.5 && near;
#else
    return false;
#endif
}

// The share of the light that rays see through the map. [ARHM00]
float gn_pcss_by_rays(GnLookup at, sampler2DArray depth, GnExtentRegion region, GnPcssParams params, float noise) {
#ifdef GN_PCSS_RAYS
    GnSmrtParams rays = GnSmrtParams(params.rays, GN_PCSS_RAY_STEPS, params.least, GN_SMRT_EXTENDED, GN_PCSS_RAYS_STEEPEST, 0);
    return gn_smrt_share(at, depth, gn_smrt_light(at.light, at.receiver.p_ws), region.spread, rays, noise);
#else
    return -1.0;
#endif
}

GnPcssFound gn_pcss_search(GnLookup at, sampler2DArray depth, GnExtentLight half_light, GnExtentRegion region,
                           GnPcssParams params, float noise) {
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnPcssFound result = GnPcssFound(-1.0, region.receiver, region.receiver);
    GnExtentKernel kernel = gn_extent_kernel(at, half_light, region.spread);
    GnExtentWiden widen = gn_extent_widen(kernel, params.least * at.projected.texel_ts, 0.0);
    int taps = gn_pcss_count(GN_PCSS_KERNEL, params.search_taps);
    GnPcssKernel points = gn_pcss_kernel(params, half_light.square, taps, noise);
    float sum = 0.0;
    float count = 0.0;
    float nearest = result.receiver;
    for (int i = 0; i < taps; ++i) {
        GnPcssTap tap = gn_pcss_tap(at, depth, metres, gn_extent_tap_ts(at, kernel, widen, gn_pcss_next(points)));
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
    GnExtentRegion region = gn_pcss_where(at, GN_PCSS_THESE, half_light, params);
    if (region.visibility >= 0.0) {
        return region.visibility;
    }
    if (gn_pcss_caged(at, half_light, region, params)) {
        return gn_pcss_by_rays(at, depth, region, params, noise);
    }
    GnPcssFound found = gn_pcss_search(at, depth, half_light, region, params, noise);
    if (found.visibility >= 0.0) {
        return found.visibility;
    }
    float spread = gn_extent_spread_at(at, found.receiver, found.blocker);
    float least_ts = params.least * at.projected.texel_ts;
    GnExtentKernel kernel = gn_extent_kernel(at, half_light, spread);
    GnExtentWiden widen = gn_extent_widen(kernel, 0.0, least_ts);
    vec2 reach_ts = gn_extent_reach(kernel, half_light.square);
    float width = max(max(reach_ts.x, reach_ts.y), least_ts) / at.projected.texel_ts;
    int taps = gn_pcss_count(GN_PCSS_KERNEL, clamp(int(ceil(params.density * width)), min(4, params.taps), params.taps));
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnPcssKernel points = gn_pcss_kernel(params, half_light.square, taps, noise);
    float lit = 0.0;
    for (int i = 0; i < taps; ++i) {
        lit += gn_pcss_lit(at, depth, metres, params, gn_extent_tap_ts(at, kernel, widen, gn_pcss_next(points)));
    }
    return lit / float(taps);
}

// Why a search ended: 1 all of the light is seen, 2 none of it, 3 the texels had to be read, 4 by rays.
float gn_pcss_search_class(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnExtentRegion region = gn_pcss_where(at, GN_PCSS_THESE, half_light, params);
    if (region.visibility >= 0.0) {
        return region.visibility == 1.0 ? 1.0 : 2.0;
    }
    return gn_pcss_caged(at, half_light, region, params) ? 4.0 : 3.0;
}

// What the search finds where no region decides.
GnPcssFound gn_pcss_blockers(GnLookup at, GN_PCSS_MAPS, GnExtentLight half_light, GnPcssParams params) {
    GnExtentRegion region = gn_pcss_where(at, GN_PCSS_THESE, half_light, params);
    if (region.visibility >= 0.0) {
        return GnPcssFound(region.visibility, region.receiver, region.receiver);
    }
    return gn_pcss_search(at, depth, half_light, region, params, gn_pcss_noise(at.receiver, params));
}

// Metres along the axis from the receiver to what hides the light from it; 0 where nothing does.
float gn_pcss_blocker_distance(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    params.early_out = 0;
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnPcssFound found = gn_pcss_blockers(at, GN_PCSS_THESE, half_light, params);
    return found.visibility >= 0.0 ? 0.0 : found.receiver - found.blocker;
}

// Metres across the penumbra, where it lies across the axis; 0 where nothing hides the light.
float gn_pcss_penumbra_width(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    params.early_out = 0;
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnPcssFound found = gn_pcss_blockers(at, GN_PCSS_THESE, half_light, params);
    return found.visibility >= 0.0 ? 0.0 : gn_extent_width(half_light, gn_extent_spread_at(at, found.receiver, found.blocker));
}

// Half the shorter side of the filter on the light's plane, before `least` widens it; 0 where all of the light is seen or none.
float gn_pcss_filter_radius(GnLookup at, GN_PCSS_MAPS, GnPcssParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnPcssFound found = gn_pcss_blockers(at, GN_PCSS_THESE, half_light, params);
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
