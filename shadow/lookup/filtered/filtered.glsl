// SPDX-License-Identifier: MIT
// The footprint of a receiver in a prefiltered map; what the map stores, the map's own function reads.
// Based on: Donnelly, Lauritzen. Variance Shadow Maps. I3D 2006. [DL06]
#ifndef GN_SHADOW_LOOKUP_FILTERED_GLSL
#define GN_SHADOW_LOOKUP_FILTERED_GLSL

#include "shadow/lookup/filtered/filtered.h"
#include "shadow/receiver/receiver.glsl"

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
float gn_filtered_visibility(GnLookup at, GnFilteredParams params) {
    GnFootprint footprint = gn_filtered_footprint(at.receiver, at.projected, params);
    return GN_MAP_VISIBILITY(at, footprint.ddx_ts, footprint.ddy_ts);
}

#endif
#endif
