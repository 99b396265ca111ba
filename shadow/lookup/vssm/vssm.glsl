// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows in a few fetches of a prefiltered map: the map tells the mean depth of what hides the light, and
// filters as wide as that makes the penumbra.
// Based on: Yang, Dong, Feng, Seidel, Kautz. Variance Soft Shadow Mapping. Pacific Graphics 2010. [YDF+10]
// Departs from it: any map that is filterable and tells its blockers serves; the parts of a kernel follow the receiver's plane, and
// are always as many. Where the texels of a part agree, they say what of it is lit, and its moments are not asked.
#ifndef GN_SHADOW_LOOKUP_VSSM_GLSL
#define GN_SHADOW_LOOKUP_VSSM_GLSL

#include "shadow/receiver/light_extent.glsl"
#include "shadow/lookup/vssm/vssm.h"
#include "shadow/receiver/map_any.glsl"

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

// Half the sides of the rectangle of the map around all of a kernel's parts.
GN_FN vec2 gn_vssm_around(GnVssmKernel kernel, int side) {
    return (1.0f - 1.0f / float(side)) * (abs(kernel.right_ts) + abs(kernel.up_ts)) + kernel.box_ts;
}

// How many times farther along the map's axes a kernel's parts lie than the light's points, at most: of a rectangle no farther,
// of a disc share ((1 - 1/side)(|r| + |u|) + sqrt(r^2 + u^2)/side) against sqrt(r^2 + u^2), with |r| + |u| <= sqrt(2 (r^2 + u^2)).
GN_FN float gn_vssm_overhang(bool square, int side) {
    float part = 1.0f / float(side);
    return square ? 1.0f : max(gn_vssm_share(false) * (1.41421356f * (1.0f - part) + part), 1.0f);
}

GN_FN GnVssmKernel gn_vssm_kernel(GnLookup at, GnExtentLight half_light, float spread, float least_ts, int side) {
    GnExtentKernel points = gn_extent_kernel(at, half_light, spread);
    GnExtentWiden widen = gn_extent_widen(points, 0.0f, least_ts);
    vec4 axes_ts = gn_extent_axes(points);
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

// What the texels of a rectangle say where they agree: 1 that all of the receiver's plane is lit, 0 that none is, else -1.
// `around`: where they are; `plane`: whose plane reaches there. Half a texel more, as the map's filter reads.
float gn_vssm_agreed(GnLookup plane, GnLookup around, sampler2DArray pyramid, vec2 half_ts) {
    GnProjected projected = around.projected;
    half_ts += 0.5 * projected.texel_ts;
    vec2 low_ts = projected.uv_ts - half_ts;
    vec2 high_ts = projected.uv_ts + half_ts;
    if (!gn_within_view(projected, low_ts, high_ts)) {
        return -1.0;
    }
    ivec2 first = ivec2(floor(low_ts / projected.texel_ts));
    ivec2 last = max(ivec2(floor(min(high_ts, projected.bounds_ts.zw - 0.5 * projected.texel_ts) / projected.texel_ts)), first);
    vec2 range = gn_plane_range(plane, projected.uv_ts, half_ts + projected.texel_ts);
    bvec2 beyond = gn_pyramid_beyond(pyramid, first, last, projected.layer, range);
    return !beyond.x ? 0.0 : beyond.y ? -1.0 : 1.0;
}

struct GnVssmFound {
    float visibility;  // 0 or 1 where the extremes decide or nothing was found, else -1
    float receiver;    // metres along the axis
    float blocker;     // likewise, on average
};

// What hides the light in each part of the region where anything can, and how far away it is.
GnVssmFound gn_vssm_search(GnLookup at, sampler2DArray pyramid, GnExtentLight half_light, GnVssmParams params) {
    GnExtentMetres metres = gn_extent_metres_of(at);
    // The region holds all that the parts read, or its extremes would decide on fewer texels than they do. Two axes reach as far
    // along one of the map's as both are long.
    float overhang = gn_vssm_overhang(half_light.square, params.side);
    GnExtentLight parts_light = GnExtentLight(overhang * half_light.right_ws, overhang * half_light.up_ws, half_light.square);
    float more = 2.0 * overhang * params.least + 0.5;
    GnExtentRegion region = gn_extent_region(at, pyramid, parts_light, metres, more, params.early_out != 0);
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
        distance += found.x * gn_extent_seen(at, part, metres, middle_ts, part.projected.uv_ts, part.projected.depth, depth);
    }
    if (hidden <= 1.0e-3 * float(parts)) {
        // Moments that find nothing are wrong where all texels hide the light.
        bool all_hidden = gn_vssm_agreed(at, at, pyramid, gn_vssm_around(kernel, params.side)) == 0.0;
        result.visibility = all_hidden ? -1.0 : 1.0;
        result.blocker = min(region.nearest, region.receiver);
        return result;
    }
    result.blocker = clamp(distance / hidden, min(region.nearest, region.receiver), region.receiver);
    return result;
}

float gn_vssm_visibility(GnLookup at, sampler2DArray pyramid, GnVssmParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnVssmFound found = gn_vssm_search(at, pyramid, half_light, params);
    if (found.visibility >= 0.0) {
        return found.visibility;
    }

    // Filter as wide as the penumbra.
    int parts = params.side * params.side;
    float least_ts = params.least * at.projected.texel_ts;
    float spread = gn_extent_spread_at(at, found.receiver, found.blocker);
    GnVssmKernel kernel = gn_vssm_kernel(at, half_light, spread, least_ts, params.side);
    float lit = 0.0;
    for (int i = 0; i < parts; ++i) {
        vec2 q = gn_vssm_part(i, params.side);
        vec2 middle_ts = at.projected.uv_ts + q.x * kernel.right_ts + q.y * kernel.up_ts;
        GnLookup part = gn_vssm_beside(at, middle_ts);
        bool within = gn_within_view(at.projected, middle_ts, middle_ts);
        float agreed = gn_vssm_agreed(within ? at : part, part, pyramid, kernel.box_ts);
        lit += agreed >= 0.0 ? agreed
                             : GN_MAP_VISIBILITY(part, vec2(2.0 * kernel.box_ts.x, 0.0), vec2(0.0, 2.0 * kernel.box_ts.y));
    }
    return lit / float(parts);
}

// Metres along the axis from the receiver to what hides the light from it; 0 where nothing does.
float gn_vssm_blocker_distance(GnLookup at, sampler2DArray pyramid, GnVssmParams params) {
    params.early_out = 0;
    GnVssmFound found = gn_vssm_search(at, pyramid, gn_extent_light(at.light, at.receiver.p_ws), params);
    return found.visibility >= 0.0 ? 0.0 : found.receiver - found.blocker;
}

// Metres across the penumbra, where it lies across the axis; 0 where nothing hides the light.
float gn_vssm_penumbra_width(GnLookup at, sampler2DArray pyramid, GnVssmParams params) {
    params.early_out = 0;
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnVssmFound found = gn_vssm_search(at, pyramid, half_light, params);
    return found.visibility >= 0.0 ? 0.0 : gn_extent_width(half_light, gn_extent_spread_at(at, found.receiver, found.blocker));
}

#endif
#endif
