// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows in a few fetches of a prefiltered map: the map tells the mean depth of what hides the light, and
// filters as wide as that makes the penumbra.
// Based on: Yang, Dong, Feng, Seidel, Kautz. Variance Soft Shadow Mapping. Pacific Graphics 2010. [YDF+10]
// Departs from it: any map that is filterable and tells its blockers serves; the parts of a kernel follow the receiver's plane, and
// are always as many.
#ifndef GN_SHADOW_LOOKUP_VSSM_GLSL
#define GN_SHADOW_LOOKUP_VSSM_GLSL

#include "shadow/lookup/pcss/pcss_light.glsl"
#include "shadow/lookup/vssm/vssm.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What stands for the light on the map: half the sides of a parallelogram, in whose parts the middles of the fetches lie, and of
// the box around each of them, which lies along the map's axes as tables and mips do.
struct GnVssmKernel {
    vec2 right_ts;
    vec2 up_ts;
    vec2 box_ts;
};

// Of a disc the square whose points lie as far from the middle, on the root mean square: 1/4 of r^2 along each axis is 1/3 of
// the square of half the side.
GN_FN float gn_vssm_share(bool square) { return square ? 1.0f : 0.8660254f; }

// Half the sides of the box along the map's axes whose points lie as far from the middle along each of them as a parallelogram's.
GN_FN vec2 gn_vssm_box(vec2 right_ts, vec2 up_ts) { return sqrt(right_ts * right_ts + up_ts * up_ts); }

GN_FN GnVssmKernel gn_vssm_kernel(GnLookup at, GnPcssLight half_light, float spread, float least_ts, int side) {
    GnPcssKernel points = gn_pcss_kernel(at, half_light, spread);
    GnPcssWiden widen = gn_pcss_widen(points, 0.0f, least_ts);
    vec4 axes_ts = gn_pcss_axes(points);
    float share = gn_vssm_share(half_light.square);
    GnVssmKernel kernel;
    kernel.right_ts = share * (vec2(axes_ts.x, axes_ts.y) + widen.right_ts);
    kernel.up_ts = share * (vec2(axes_ts.z, axes_ts.w) + widen.up_ts);
    kernel.box_ts = gn_vssm_box(kernel.right_ts, kernel.up_ts) / float(side);
    return kernel;
}

// The middle of part i of side * side, in half sides of the kernel.
GN_FN vec2 gn_vssm_part(int i, int side) {
    return (2.0f * vec2(float(i % side), float(i / side)) + 1.0f) / float(side) - 1.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#elif defined(GN_MAP_VISIBILITY)

// The map's own answers, which the host calls by these names:
//   #define GN_MAP_VISIBILITY(at, ddx_ts, ddy_ts) 1.0
//   with #define GN_MAP_BLOCKERS(at, ddx_ts, ddy_ts) vec2(0.0)
// Where kernels cross views:
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view
//   with #define GN_MAP_VISIBILITY(at, ddx_ts, ddy_ts) 1.0
//   with #define GN_MAP_BLOCKERS(at, ddx_ts, ddy_ts) vec2(0.0)

// The receiver moved along its own plane to where the map sees a part's middle.
GnLookup gn_vssm_beside(GnLookup at, vec2 middle_ts) {
#ifdef GN_CROSSING
    if (!gn_within_view(at.projected, middle_ts, middle_ts)) {
        return gn_at_tap(at, middle_ts);
    }
#endif
    GnLookup beside = at;
    beside.projected.uv_ts = clamp(middle_ts, at.projected.bounds_ts.xy, at.projected.bounds_ts.zw);
    beside.projected.depth = gn_depth_at(at.projected, beside.projected.uv_ts, at.bias);
    return beside;
}

struct GnVssmFound {
    float visibility;  // 0 or 1 where the extremes decide or nothing was found, else -1
    float receiver;    // metres along the axis
    float blocker;     // likewise, on average
};

// What hides the light in each part of the region where anything can, and how far away it is.
GnVssmFound gn_vssm_search(GnLookup at, sampler2DArray pyramid, GnPcssLight half_light, GnVssmParams params) {
    GnPcssMetres metres = gn_pcss_metres_of(at);
    GnPcssRegion region = gn_pcss_region(at, pyramid, half_light, metres, params.least, params.early_out != 0);
    GnVssmFound result = GnVssmFound(region.visibility, region.receiver, region.receiver);
    if (result.visibility >= 0.0) {
        return result;
    }
    int parts = params.side * params.side;
    float least_ts = params.least * at.projected.texel_ts;
    GnVssmKernel kernel = gn_vssm_kernel(at, half_light, region.spread, least_ts, params.side);
    float hidden = 0.0;
    float distance = 0.0;
    for (int i = 0; i < parts; ++i) {
        vec2 q = gn_vssm_part(i, params.side);
        vec2 middle_ts = at.projected.uv_ts + q.x * kernel.right_ts + q.y * kernel.up_ts;
        GnLookup part = gn_vssm_beside(at, middle_ts);
        vec2 found = GN_MAP_BLOCKERS(part, vec2(2.0 * kernel.box_ts.x, 0.0), vec2(0.0, 2.0 * kernel.box_ts.y));
        float depth = clamp(found.y, 0.0, max(part.projected.depth, 0.0));
        hidden += found.x;
        distance += found.x * gn_pcss_seen(at, part, metres, middle_ts, part.projected.uv_ts, part.projected.depth, depth);
    }
    if (hidden <= 1.0e-3 * float(parts)) {
        result.visibility = 1.0;
        return result;
    }
    result.blocker = clamp(distance / hidden, min(region.nearest, region.receiver), region.receiver);
    return result;
}

float gn_vssm_visibility(GnLookup at, sampler2DArray pyramid, GnVssmParams params) {
    GnPcssLight half_light = gn_pcss_light(at.light, at.receiver.p_ws);
    GnVssmFound found = gn_vssm_search(at, pyramid, half_light, params);
    if (found.visibility >= 0.0) {
        return found.visibility;
    }

    // Filter as wide as the penumbra.
    int parts = params.side * params.side;
    float least_ts = params.least * at.projected.texel_ts;
    float spread = gn_pcss_spread_at(at, found.receiver, found.blocker);
    GnVssmKernel kernel = gn_vssm_kernel(at, half_light, spread, least_ts, params.side);
    float lit = 0.0;
    for (int i = 0; i < parts; ++i) {
        vec2 q = gn_vssm_part(i, params.side);
        GnLookup part = gn_vssm_beside(at, at.projected.uv_ts + q.x * kernel.right_ts + q.y * kernel.up_ts);
        lit += GN_MAP_VISIBILITY(part, vec2(2.0 * kernel.box_ts.x, 0.0), vec2(0.0, 2.0 * kernel.box_ts.y));
    }
    return lit / float(parts);
}

// Metres along the axis from the receiver to what hides the light from it; 0 where nothing does.
float gn_vssm_blocker_distance(GnLookup at, sampler2DArray pyramid, GnVssmParams params) {
    params.early_out = 0;
    GnVssmFound found = gn_vssm_search(at, pyramid, gn_pcss_light(at.light, at.receiver.p_ws), params);
    return found.visibility >= 0.0 ? 0.0 : found.receiver - found.blocker;
}

// Metres across the penumbra, where it lies across the axis; 0 where nothing hides the light.
float gn_vssm_penumbra_width(GnLookup at, sampler2DArray pyramid, GnVssmParams params) {
    params.early_out = 0;
    GnPcssLight half_light = gn_pcss_light(at.light, at.receiver.p_ws);
    GnVssmFound found = gn_vssm_search(at, pyramid, half_light, params);
    return found.visibility >= 0.0 ? 0.0 : gn_pcss_width(half_light, gn_pcss_spread_at(at, found.receiver, found.blocker));
}

#endif
#endif
