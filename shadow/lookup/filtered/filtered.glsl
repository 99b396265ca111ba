// SPDX-License-Identifier: MIT
// The footprint of a receiver in a prefiltered map; what the map stores, the map's own function reads.
// Based on: Donnelly, Lauritzen. Variance Shadow Maps. I3D 2006. [DL06]
#ifndef GN_SHADOW_LOOKUP_FILTERED_GLSL
#define GN_SHADOW_LOOKUP_FILTERED_GLSL

#include "shadow/lookup/filtered/filtered.h"
#include "shadow/receiver/map_access.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Two axes of the region to average, in ts: sides of a parallelogram around uv.
struct GnFootprint {
    vec2 ddx_ts;
    vec2 ddy_ts;
};

GN_FN GnFootprint gn_filtered_footprint(GnReceiver receiver, GnProjected projected, GnFilteredParams params) {
    GnFootprint footprint;
    if (params.footprint == GN_FILTERED_PIXEL) {
        // What the pixel covers.
        footprint.ddx_ts = vec2(dot(projected.du_ws, receiver.ddx_ws), dot(projected.dv_ws, receiver.ddx_ws)) / params.sharpness;
        footprint.ddy_ts = vec2(dot(projected.du_ws, receiver.ddy_ws), dot(projected.dv_ws, receiver.ddy_ws)) / params.sharpness;
        return footprint;
    }
    vec2 side_ts = vec2(2.0f * params.radius * projected.texel_ts);
    if (params.footprint == GN_FILTERED_WORLD && params.radius_world > 0.0f) {
        side_ts = gn_texels(projected, 2.0f * params.radius_world) * projected.texel_ts;
    }
    footprint.ddx_ts = vec2(side_ts.x, 0.0f);
    footprint.ddy_ts = vec2(0.0f, side_ts.y);
    return footprint;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#elif defined(GN_MAP_VISIBILITY)

// The map's own answer, which the host calls by this name:
//   #define GN_MAP_VISIBILITY(at, ddx_ts, ddy_ts) 1.0
// Where kernels cross views:
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view
//   with #define GN_MAP_VISIBILITY(at, ddx_ts, ddy_ts) 1.0
float gn_filtered_visibility(GnLookup at, GnFilteredParams params) {
    GnFootprint footprint = gn_filtered_footprint(at.receiver, at.projected, params);
#ifdef GN_CROSSING
    // A footprint that leaves the view is four quarters, each in the view that serves its middle.
    vec2 reach_ts = 0.5 * (abs(footprint.ddx_ts) + abs(footprint.ddy_ts)) + at.projected.texel_ts;
    if (!gn_within_view(at.projected, at.projected.uv_ts - reach_ts, at.projected.uv_ts + reach_ts)) {
        float sum = 0.0;
        for (int i = 0; i < 4; ++i) {
            vec2 side = vec2((i & 1) == 0 ? -0.25 : 0.25, (i & 2) == 0 ? -0.25 : 0.25);
            vec2 middle_ts = at.projected.uv_ts + side.x * footprint.ddx_ts + side.y * footprint.ddy_ts;
            GnLookup tap = gn_at_tap(at, middle_ts);
            GnFootprint quarter = gn_filtered_footprint(tap.receiver, tap.projected, params);
            sum += GN_MAP_VISIBILITY(tap, 0.5 * quarter.ddx_ts, 0.5 * quarter.ddy_ts);
        }
        return 0.25 * sum;
    }
#endif
    return GN_MAP_VISIBILITY(at, footprint.ddx_ts, footprint.ddy_ts);
}

#endif
#endif
