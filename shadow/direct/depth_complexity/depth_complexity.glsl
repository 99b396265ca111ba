// SPDX-License-Identifier: MIT
// Based on: Laine, Aila, Assarsson, Lehtinen, Akenine-Moller. Soft Shadow Volumes for Ray Tracing. ACM TOG 2005. [LAAL05]
// Based on: Forest, Barthe, Paulin. Accurate Shadows by Depth Complexity Sampling. CGF 2008. [FBP08]
//
// What a silhouette edge adds to the number of surfaces before each point of a light; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_DEPTH_COMPLEXITY_GLSL
#define GN_SHADOW_DIRECT_DEPTH_COMPLEXITY_GLSL

#include "shadow/direct/depth_complexity/depth_complexity.h"
#include "shadow/geometry/occluder.glsl"
#include "shadow/geometry/seen_light.glsl"
#include "shadow/geometry/volumes.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// An edge on the light's plane, in coordinates in which the light lies in the square from -1 to 1, from its ends as the receiver
// sees them; false where it passes the square by. Ends between receiver and light are taken as they are: edges that share
// one find the same place for it.
GN_FN bool gn_depth_edge(GnSeenLight seen, bool sun, vec3 from_a, vec3 from_b, GN_OUT(vec2) a, GN_OUT(vec2) b) {
    a = vec2(0.0f);
    b = vec2(0.0f);
    // What lies beside the receiver is seen so far from the light that it may end there; not so far that rounding of its end moves
    // the edge before the light.
    float low = 1.0e-4f * (length(from_a) + length(from_b));
    float high = sun ? 1.0e30f : seen.height * (1.0f - 1.0e-4f);
    float ha = dot(from_a, seen.forward_ws);
    float hb = dot(from_b, seen.forward_ws);
    if (low >= high || max(ha, hb) <= low || min(ha, hb) >= high) {
        return false;
    }
    vec3 along = from_b - from_a;
    float at_a = clamp(ha, low, high);
    float at_b = clamp(hb, low, high);
    vec3 end_a = at_a == ha ? from_a : from_a + along * ((at_a - ha) / (hb - ha));
    vec3 end_b = at_b == hb ? from_b : from_a + along * ((at_b - ha) / (hb - ha));
    a = gn_on_light(seen, end_a);
    b = gn_on_light(seen, end_b);
    return !(min(a.x, b.x) > 1.0f || max(a.x, b.x) < -1.0f || min(a.y, b.y) > 1.0f || max(a.y, b.y) < -1.0f);
}

// +1 where the plane's axes turn left as seen from beyond the light, from where triangles that face it run left around; else -1.
GN_FN int gn_depth_turn(GnSeenLight seen) {
    return dot(cross(seen.x_ws, seen.y_ws), seen.forward_ws) > 0.0f ? 1 : -1;
}

// What an edge adds to the counter of a point q in the square: how often it crosses, from right to left less from left to right, the
// way from q to the square's right side and up along that, to infinity. A closed silhouette crosses it as often as it
// winds around q. Edges that miss the square add the same to all points in it, so that they may be left out. [LAAL05]
// section 4.1, whose edges that leave on the right add to all samples on one side
GN_FN int gn_depth_crossings(vec2 a, vec2 b, vec2 q) {
    vec2 d = b - a;
    // Of an edge in the sample's horizon one end is seen ten thousand lights away: products with it would round to whole lights.
    vec2 near = dot(a, a) < dot(b, b) ? a : b;
    int row = int(b.y > q.y) - int(a.y > q.y);           // through q's row, upwards
    int column = int(a.x > 1.0f) - int(b.x > 1.0f);      // through the right side's line, to the left
    float at_q = d.x * (q.y - near.y) - d.y * (q.x - near.x);  // on which side of the edge q lies,
    bool turn_left = d.x * (q.y - near.y) > d.y * (1.0f - near.x);  // and the corner of its way
    bool after_q = float(row) * at_q > 0.0f;
    // An edge through the very corner is before it or after it on both legs of the way.
    bool after_turn = column != 0 ? turn_left == (row > 0) : a.x > 1.0f;
    bool above = row != 0 ? turn_left == (column > 0) : a.y > q.y;
    return (after_q && !after_turn ? row : 0) + (above ? column : 0);
}

// How often a triangle counts for a receiver: 1 as wound, -1 turned over, 0 not at all. What lies between the receiver and a point
// of the light is seen from both with opposite sides; a triangle whose plane holds the receiver hides nothing from it. No other
// is left out: edges that bound it would be silhouettes from nowhere else. `owner` and `form` as volumes have them.
GN_FN int gn_depth_multiplicity(vec3 a_ws, vec3 b_ws, vec3 c_ws, uint owner, uint form, vec3 p_ws, vec3 n_ws) {
    GnPlane plane = gn_plane(a_ws, b_ws, c_ws);
    vec3 magnitude = max(max(abs(p_ws), abs(a_ws)), max(abs(b_ws), abs(c_ws)));
    vec3 d = p_ws - a_ws;
    if (!(plane.size > 0.0f) || gn_plane_holds(plane, d, magnitude) || gn_plane_near(plane, d, n_ws, magnitude)) {
        return 0;
    }
    int side = -gn_volumes_side(a_ws, b_ws, c_ws, vec4(p_ws, 1.0f));
    side = (owner & 2u) != 0u ? max(side, 0) : side;
    return gn_volumes_multiplicity(side, int(form & 3u));
}

// How far from the centre of a round light edges are asked: to the corners of its square; of a sphere, which is seen as a larger disc
// from nearby, to those of a disc twice as large, as samples a seventh of its radius above it see it. 0 of a rectangle.
GN_FN float gn_depth_radius(GnLight light) {
    float corner = light.kind == uint(GN_LIGHT_RECTANGLE) ? 0.0f : 1.4143f * gn_light_half_size(light).x;
    return light.kind == uint(GN_LIGHT_POINT) ? 2.0f * corner : corner;
}

// Whether some points of a light lie before a triangle and some behind it, or may: an edge of it that is no silhouette from the
// light's centre may be one from there. The half axes of a rectangle, and gn_depth_radius.
GN_FN bool gn_depth_cuts_light(vec3 a_ws, vec3 b_ws, vec3 c_ws, vec4 light_ws, vec3 x_ws, vec3 y_ws, float radius) {
    vec3 n = cross(b_ws - a_ws, c_ws - a_ws);
    vec3 to_light = vec3(light_ws) - a_ws * light_ws.w;
    float reach = abs(dot(n, x_ws)) + abs(dot(n, y_ws)) + radius * length(n);
    return abs(dot(n, to_light)) <= 1.001f * reach + 1.0e-5f * dot(abs(n), abs(to_light));
}

// Counters of 8 or 16 bits in words: what is added to one, in the place of field `field`. Words add modulo 2^32, whatever they
// hold in between; in the end they are right where each counter fits its bits.
GN_FN uint gn_depth_packed(int count, uint field, uint bits) {
    return uint(count) << (field * bits);
}
GN_FN int gn_depth_unpacked(uint word, uint field, uint bits) {
    uint half_range = 1u << (bits - 1u);
    uint bias = bits == 8u ? 0x80808080u : 0x80008000u;
    return int(((word + bias) >> (field * bits)) & (2u * half_range - 1u)) - int(half_range);
}

// What three references say of the number that makes counters numbers of surfaces, each at its height above the horizon of the
// sample's surface. Near the horizon, where the surface's own edges end, rounding decides: the highest speaks for those that are low.
GN_FN ivec3 gn_depth_heard(ivec3 votes, vec3 heights) {
    float highest = max(heights.x, max(heights.y, heights.z));
    int best = heights.x == highest ? votes.x : heights.y == highest ? votes.y : votes.z;
    return ivec3(heights.x > 0.25f * highest ? votes.x : best, heights.y > 0.25f * highest ? votes.y : best,
                 heights.z > 0.25f * highest ? votes.z : best);
}

// That number: the one of which two are sure, else the first. No point has fewer surfaces before it than none. [LAAL05] section 4.2,
// by volumes as [FBP08] does
GN_FN int gn_depth_constant(ivec3 votes, int least) {
    int constant = votes.y == votes.z ? votes.y : votes.x;
    return max(constant, -least);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
