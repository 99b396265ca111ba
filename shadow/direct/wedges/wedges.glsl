// SPDX-License-Identifier: MIT
// Based on: Akenine-Moller, Assarsson. Approximate Soft Shadows on Arbitrary Surfaces Using Penumbra Wedges. EGWR 2002. [AA02]
//
// A penumbra wedge, and the light in it; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_WEDGES_GLSL
#define GN_SHADOW_DIRECT_WEDGES_GLSL

#include "shadow/direct/wedges/wedges.h"
#include "shadow/geometry/seen_light.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The wedge of an edge in its own frame: along the edge, out of the shadow (the hard plane's normal), away from the light.
struct GnWedge {
    vec3 a_ws, b_ws;  // the ends, both as far from the light
    vec3 along_ws, out_ws, away_ws;
    vec2 fall;        // of the light's centre from the ends, along_ws: metres a metre along away_ws
    vec2 side;        // by how much more an angle the side planes open, radians
    float slope;      // of front and back plane: metres along out_ws a metre along away_ws
};

// Half of the light's extent along a unit direction.
GN_FN float gn_wedges_extent(GnLight light, vec3 along_ws) {
    vec2 size = gn_light_half_size(light);
    return light.kind == uint(GN_LIGHT_RECTANGLE)
               ? abs(dot(along_ws, vec3(light.right_ws))) * size.x + abs(dot(along_ws, vec3(light.up_ws))) * size.y
               : size.x;
}

// The tangent of the angle by which a plane at a distance of 1 is turned to touch a sphere of this radius (asin), or to reach
// that far across (atan).
GN_FN float gn_wedges_slope(float radius, int turn) {
    return turn == GN_WEDGES_ATAN ? radius : radius / sqrt(max(1.0f - radius * radius, 1.0e-4f));
}

// [AA02] section 3.1: the end farther from the light is moved towards it, so that the edge lies across; front and back plane are
// the hard plane turned about it, the side planes stand on both ends.
GN_FN GnWedge gn_wedge(GnLight light, vec3 a_ws, vec3 b_ws, int turn) {
    bool sun = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    vec3 centre_ws = vec3(light.position_ws);
    GnWedge w;
    w.a_ws = a_ws;
    w.b_ws = b_ws;
    float line = 1.0f;
    if (sun) {
        vec3 to_sun_ws = -vec3(light.direction_ws);
        float higher = dot(a_ws - b_ws, to_sun_ws);
        w.a_ws = higher < 0.0f ? a_ws - to_sun_ws * higher : a_ws;
        w.b_ws = higher > 0.0f ? b_ws + to_sun_ws * higher : b_ws;
        w.along_ws = normalize(w.b_ws - w.a_ws);
        w.out_ws = normalize(cross(-to_sun_ws, w.along_ws));
        w.away_ws = -to_sun_ws;
        w.fall = vec2(0.0f);
    } else {
        float from_a = length(a_ws - centre_ws);
        float from_b = length(b_ws - centre_ws);
        w.a_ws = from_a > from_b ? centre_ws + (a_ws - centre_ws) * (from_b / from_a) : a_ws;
        w.b_ws = from_b > from_a ? centre_ws + (b_ws - centre_ws) * (from_a / from_b) : b_ws;
        w.along_ws = normalize(w.b_ws - w.a_ws);
        w.out_ws = normalize(cross(w.a_ws - centre_ws, w.along_ws));
        w.away_ws = cross(w.out_ws, w.along_ws);
        w.away_ws *= dot(w.away_ws, w.a_ws - centre_ws) < 0.0f ? -1.0f : 1.0f;
        line = dot(w.a_ws - centre_ws, w.away_ws);
        w.fall = vec2(dot(w.a_ws - centre_ws, w.along_ws), dot(w.b_ws - centre_ws, w.along_ws)) / line;
    }
    w.slope = gn_wedges_slope(gn_wedges_extent(light, w.out_ws) / line, turn);
    float wide = gn_wedges_extent(light, w.along_ws) / line;
    w.side = vec2(asin(min(wide / sqrt(1.0f + w.fall.x * w.fall.x), 1.0f)),
                  asin(min(wide / sqrt(1.0f + w.fall.y * w.fall.y), 1.0f)));
    return w;
}

// What the wedge hides of the light at a point beyond what the hard shadow says, or shows (less than 0): light grows along the hard
// plane's normal from the back plane to the front plane. [AA02] section 3.2: |p - i_b| / |i_f - i_b|
GN_FN float gn_wedge_hidden(GnWedge w, vec3 p_ws) {
    float height = dot(p_ws - w.a_ws, w.out_ws);
    float depth = dot(p_ws - w.a_ws, w.away_ws);
    float reach = w.slope * depth;
    bool inside = depth > 0.0f && abs(height) < reach;
    // Angles from the hard plane's way away from the light, in the plane of the edge.
    float at_a = atan(dot(p_ws - w.a_ws, w.along_ws), depth);
    float at_b = atan(dot(p_ws - w.b_ws, w.along_ws), depth);
    inside = inside && at_a > atan(w.fall.x) - w.side.x && at_b < atan(w.fall.y) + w.side.y;
    float light = 0.5f + 0.5f * height / max(reach, 1.0e-30f);
    return inside ? (height > 0.0f ? 1.0f - light : -light) : 0.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
