// SPDX-License-Identifier: MIT
// Which depth around a cell answers for a receiver in it.
// Based on: Sen, Cammarano, Hanrahan. Shadow Silhouette Maps. SIGGRAPH 2003. [SCH03]
#ifndef GN_SHADOW_LOOKUP_SILHOUETTE_GLSL
#define GN_SHADOW_LOOKUP_SILHOUETTE_GLSL

#include "shadow/map/silhouette_map/silhouette_map.glsl"
#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

GN_FN float gn_silhouette_cross(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Whether p lies between two directions, counter-clockwise from the first; they may enclose more than half a turn.
GN_FN bool gn_silhouette_between(vec2 p, vec2 from, vec2 to) {
    bool after = gn_silhouette_cross(from, p) >= 0.0f;
    bool before = gn_silhouette_cross(p, to) >= 0.0f;
    return gn_silhouette_cross(from, to) >= 0.0f ? after && before : after || before;
}

// [SCH03] 4.2: lines from the cell's point to those of its four neighbours make four skewed quadrants with one corner
// each. All points are in the cell's space.
GN_FN ivec2 gn_silhouette_corner(vec2 p, vec2 centre, vec2 right, vec2 above, vec2 left, vec2 below) {
    vec2 d = p - centre;
    if (gn_silhouette_between(d, right - centre, above - centre)) {
        return ivec2(1, 1);
    }
    if (gn_silhouette_between(d, above - centre, left - centre)) {
        return ivec2(0, 1);
    }
    return gn_silhouette_between(d, left - centre, below - centre) ? ivec2(0, 0) : ivec2(1, 0);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// The first and the last texel of the view's rectangle: beyond it other views begin.
ivec4 gn_silhouette_bounds(GnProjected projected) {
    ivec4 bounds = ivec4(projected.bounds_ts / projected.texel_ts + 0.5);
    return ivec4(bounds.xy, bounds.zw - 1);
}

vec2 gn_silhouette_fetch(sampler2DArray map, ivec2 cell, ivec2 step, int layer, ivec4 bounds) {
    float packed = texelFetch(map, ivec3(clamp(cell + step, bounds.xy, bounds.zw), layer), 0).g;
    return gn_silhouette_unpack(packed) + vec2(step);
}

float gn_silhouette_visibility(GnLookup at, sampler2DArray map) {
    GnProjected projected = at.projected;
    // Find the receiver's cell, and its quadrant.
    vec2 p_cells = projected.uv_ts / projected.texel_ts - 0.5;
    ivec2 cell = ivec2(floor(p_cells));
    int layer = projected.layer;
    ivec4 bounds = gn_silhouette_bounds(projected);
    ivec2 corner = gn_silhouette_corner(p_cells - vec2(cell), gn_silhouette_fetch(map, cell, ivec2(0, 0), layer, bounds),
                                        gn_silhouette_fetch(map, cell, ivec2(1, 0), layer, bounds),
                                        gn_silhouette_fetch(map, cell, ivec2(0, 1), layer, bounds),
                                        gn_silhouette_fetch(map, cell, ivec2(-1, 0), layer, bounds),
                                        gn_silhouette_fetch(map, cell, ivec2(0, -1), layer, bounds));

    // Compare with the depth at the quadrant's corner, where it was sampled.
    ivec2 texel = clamp(cell + corner, bounds.xy, bounds.zw);
    vec2 corner_ts = (vec2(texel) + 0.5) * projected.texel_ts;
    float occluder = texelFetch(map, ivec3(texel, layer), 0).r;
    return gn_depth_at(projected, corner_ts, at.bias) <= occluder ? 1.0 : 0.0;
}

#endif
#endif
