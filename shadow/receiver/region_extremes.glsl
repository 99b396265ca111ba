// SPDX-License-Identifier: MIT
// What a rectangle of the map says of the receiver's plane at once: that no kernel within it finds a blocker, or nothing else.
// Based on: Akenine-Moller, Haines, Hoffman, Pesce, Iwanicki, Hillaire. Real-Time Rendering, 4th edition. 2018. [AHH18], 7.6.
#ifndef GN_SHADOW_RECEIVER_REGION_EXTREMES_GLSL
#define GN_SHADOW_RECEIVER_REGION_EXTREMES_GLSL

#include "shadow/receiver/map_range.glsl"
#include "shadow/receiver/map_access.glsl"

#ifndef __cplusplus

// The least and greatest depth of the receiver's plane over a rectangle of the map: the plane is flat between its corners; a cone
// lies below it, deepest at the corners.
vec2 gn_plane_range(GnLookup at, vec2 middle_ts, vec2 half_ts) {
    vec2 range = vec2(1.0e30, -1.0e30);
    for (int k = 0; k < 4; ++k) {
        vec2 corner_ts = middle_ts + half_ts * vec2((k & 1) == 0 ? -1.0 : 1.0, (k & 2) == 0 ? -1.0 : 1.0);
        float plane = gn_depth_at(at.projected, corner_ts, at.bias);
        range = vec2(min(range.x, plane), max(range.y, plane + gn_cone(at.projected, corner_ts - at.projected.uv_ts)));
    }
    return range;
}

// What the rectangle around the receiver holds, to `reach_ts` on each side: the least depth, and whether none of it or all of it hides
// the receiver's plane (1, 0), else -1. Texels that the rectangle touches count whole, each compared at its centre.
vec2 gn_region_extremes(GnLookup at, sampler2DArray pyramid, vec2 reach_ts) {
    vec2 low_ts = at.projected.uv_ts - reach_ts;
    vec2 high_ts = at.projected.uv_ts + reach_ts;
    vec2 first_ts = max(low_ts, at.projected.bounds_ts.xy);
    vec2 last_ts = min(high_ts, at.projected.bounds_ts.zw - 0.5 * at.projected.texel_ts);
    ivec2 first = ivec2(floor(first_ts / at.projected.texel_ts));
    ivec2 last = max(ivec2(floor(last_ts / at.projected.texel_ts)), first);
    int level = gn_pyramid_first(int(1.0 / at.projected.texel_ts + 0.5), textureSize(pyramid, 0).x);
    vec2 found = gn_pyramid_min_max(pyramid, first >> level, last >> level, at.projected.layer, textureQueryLevels(pyramid));
    if (!gn_within_view(at.projected, low_ts, high_ts)) {
        return vec2(found.x, -1.0);
    }
    vec2 plane = gn_plane_range(at, at.projected.uv_ts, reach_ts + at.projected.texel_ts);
    return vec2(found.x, plane.y <= found.x ? 1.0 : plane.x > found.y ? 0.0 : -1.0);
}

// Whether the receiver's plane lies before a plane that lies before all depths of the rectangle: then all of the light is seen. With
// the distance `room` between both at the receiver, the other's slopes s, the receiver's b and its fall f, what is left of it at d
// is room + s.d - b.d / (1 - f.d), and that times the divisor at least room - |s - room f - b|.h - |s|.h |f|.h where |d| <= h.
bool gn_region_before(GnLookup at, sampler2DArray planes, vec2 reach_ts) {
    GnProjected projected = at.projected;
    GnBias bias = at.bias;
    if (GN_VIEW_KIND > 1 || !gn_within_view(projected, projected.uv_ts - reach_ts, projected.uv_ts + reach_ts)) {
        return false;
    }
    ivec2 first = ivec2(floor((projected.uv_ts - reach_ts) / projected.texel_ts));
    ivec2 last = ivec2(floor(min(projected.uv_ts + reach_ts, projected.bounds_ts.zw - 0.5 * projected.texel_ts) / projected.texel_ts));
    vec3 lower = gn_lower_plane(planes, first, max(last, first), projected.layer);
    float room = lower.x + dot(lower.yz, projected.uv_ts / projected.texel_ts - 0.5 - vec2(first)) - projected.depth;
    vec2 half_ts = reach_ts + projected.texel_ts;
    vec2 slope = lower.yz / projected.texel_ts;
    vec2 own = GN_BIAS_PLANE ? projected.plane_slope : vec2(0.0);
    vec2 fall = GN_BIAS_PLANE && GN_VIEW_KIND == 1 ? projected.plane_fall : vec2(0.0);
    float fallen = dot(abs(fall), half_ts);
    return fallen < 0.5 && room >= dot(abs(slope - room * fall - own), half_ts) + dot(abs(slope), half_ts) * fallen;
}

#endif

#endif
