// SPDX-License-Identifier: MIT
// Whether a triangle hides a point of a light from a view sample: the traced truth's question, asked of one triangle.
// Compiles as GLSL and as C++.
//
// Based on: Woop, Benthin, Wald. Watertight Ray/Triangle Intersection. Journal of Computer Graphics Techniques 2013. [WBW13]
// Departs from it: each edge is a plane through the sample, whose sign says on which side the light lies; two triangles find
// the same value at the edge that they share, but for the sign, and the light on it is hidden by both.
#ifndef GN_SHADOW_GEOMETRY_OCCLUDER_GLSL
#define GN_SHADOW_GEOMETRY_OCCLUDER_GLSL

#include "base/shared.h"
#include "shadow/light_view.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// A caster's triangle, ws; with one side it casts where the light sees its front, from where it runs counter-clockwise.
struct GnOccluder {
    vec3 a;
    vec3 b;
    vec3 c;
    bool one_sided;
};

// One unit of float precision at a magnitude of 1.
const float gn_ulp = 1.0f / 8388608.0f;
// What rounding leaves of an edge of a sample's own surface, and what may seem to rise above a sample's plane that does not: 12 as
// gn_plane_rounding counts (5.5 the sample's, 5 the reading's, 1.5 the truth's), and a third more where the sample's own triangle is the
// larger one.
const float gn_near_ulps = 4.0f;
const float gn_below_ulps = 16.0f;
// How far away the truth looks for the surface that a sample lies on (reference/occluders.h, seat_ulps), in units of the largest coordinate.
const float gn_seat_ulps = 64.0f;

// What the rounding of coordinates of such magnitudes comes to along a unit vector: it moves no plane of that normal farther.
GN_FN float gn_rounding(float count, vec3 n, vec3 magnitude) {
    return count * gn_ulp * dot(abs(n), magnitude);
}

// Bit for bit the negative of what the other order gives.
GN_FN vec3 gn_cross_exact(vec3 a, vec3 b) {
    GN_PRECISE float x = a.y * b.z - a.z * b.y;
    GN_PRECISE float y = a.z * b.x - a.x * b.z;
    GN_PRECISE float z = a.x * b.y - a.y * b.x;
    return vec3(x, y, z);
}

// The planes through a sample and the triangle's edges: bc, ca, ab. A direction d meets the triangle's line of sight where
// all d . edge have one sign.
struct GnOccluderEdges {
    vec3 bc;
    vec3 ca;
    vec3 ab;
};
GN_FN GnOccluderEdges gn_occluder_edges(GnOccluder t, vec3 p_ws) {
    vec3 a = t.a - p_ws;
    vec3 b = t.b - p_ws;
    vec3 c = t.c - p_ws;
    GnOccluderEdges edges;
    edges.bc = gn_cross_exact(b, c);
    edges.ca = gn_cross_exact(c, a);
    edges.ab = gn_cross_exact(a, b);
    return edges;
}

// A triangle's plane as floats tell it.
struct GnPlane {
    vec3 normal;  // across the triangle, as long as twice its area
    float size;   // that length
    vec3 wide;    // by axis, the sum of the two products whose difference the normal is
};
GN_FN GnPlane gn_plane(vec3 a_ws, vec3 b_ws, vec3 c_ws) {
    vec3 b = b_ws - a_ws;
    vec3 c = c_ws - a_ws;
    GnPlane plane;
    plane.normal = cross(b, c);
    plane.size = length(plane.normal);
    b = abs(b);
    c = abs(c);
    plane.wide = vec3(b.y * c.z + b.z * c.y, b.z * c.x + b.x * c.z, b.x * c.y + b.y * c.x);
    return plane;
}

// How high above a plane that holds it a sample may seem to lie, times the plane's size. Let e = gn_ulp / 2 be what one rounding makes of
// 1, n the plane's unit normal, d = p - a, w = wide / size, |.| by axis, m the largest coordinates of p and of the corners. What
// errs, at most and to first order:
//   our view's sample, p = q - n (n . (q - a)) with n rounded once (shadow/view/gbuffer.glsl): n by e |n|, q - a by e |d|, the
//   product and its sums by 3 e |n|.|d|, p itself by e |p|:                              e (5 |n|.|d| + |n|.m)
//   the normal here: the edges by e, each product by 3 e, their difference by e |n|:     e (3 w.|d| + |n|.|d|)
//   d and its product with the normal:                                                   e (4 |n|.|d|)
//   sheets that were meant to be one plane, as the truth has it (plane_ulps = 1.5):      e (3 |n|.m)
// In all e (4 |n|.m + 10 |n|.|d| + 3 w.|d|): 2 units at a small triangle, 12 at one as wide as it is far, and what the normal of a
// sliver is worth.
GN_FN float gn_plane_rounding(GnPlane plane, vec3 d, vec3 magnitude) {
    return gn_ulp * (dot(abs(plane.normal), 2.0f * magnitude + 5.0f * abs(d)) + 1.5f * dot(plane.wide, abs(d)));
}

// Whether the plane holds a sample, d from the triangle's first corner, so that the triangle hides nothing from it.
GN_FN bool gn_plane_holds(GnPlane plane, vec3 d, vec3 magnitude) {
    return abs(dot(plane.normal, d)) <= gn_plane_rounding(plane, d, magnitude);
}
// Whether the plane runs along the sample's, so that the sample may be meant to lie in it.
GN_FN bool gn_plane_along(GnPlane plane, vec3 n_ws) {
    return abs(dot(plane.normal, n_ws)) > 0.99f * plane.size;
}
// Likewise, and so near that the plane may be the sample's own, where no other is known that holds it.
GN_FN bool gn_plane_near(GnPlane plane, vec3 d, vec3 n_ws, vec3 magnitude) {
    return gn_plane_along(plane, n_ws) && abs(dot(plane.normal, d)) <= gn_rounding(gn_seat_ulps, plane.normal, magnitude);
}

// Whether no corner rises above the sample's plane: what lies wholly on or below its surface hides nothing from it.
GN_FN bool gn_occluder_below(GnOccluder t, vec3 p_ws, vec3 n_ws, vec3 magnitude) {
    float above = max(max(dot(n_ws, t.a - p_ws), dot(n_ws, t.b - p_ws)), dot(n_ws, t.c - p_ws));
    return above <= gn_rounding(gn_below_ulps, n_ws, magnitude);
}

// Where rays of a sample start: a hair above its surface, so that rounding sinks none under it.
GN_FN vec3 gn_ray_origin(vec3 p_ws, vec3 n_ws) {
    return p_ws + n_ws * gn_rounding(gn_near_ulps, n_ws, abs(p_ws));
}

// What all rays of a sample to points of a light share in a triangle.
struct GnOcclusion {
    GnOccluderEdges edges;
    vec3 n;       // the triangle's unit normal; null where it has none
    float height; // of the rays' origin over the triangle's plane
    bool able;    // whether it can hide anything, from a sample that is not meant to lie on it
    bool holds;   // whether its plane holds the sample
    bool hides;   // whether it can hide anything, asked alone: what is so near that it may be the sample's own surface cannot
};
GN_FN GnOcclusion gn_occlusion(GnOccluder t, vec3 p_ws, vec3 n_ws) {
    vec3 origin_ws = gn_ray_origin(p_ws, n_ws);
    GnPlane plane = gn_plane(t.a, t.b, t.c);
    vec3 magnitude = max(max(abs(p_ws), abs(t.a)), max(abs(t.b), abs(t.c)));
    GnOcclusion o;
    o.edges = gn_occluder_edges(t, origin_ws);
    o.n = plane.size > 0.0f ? plane.normal / plane.size : vec3(0.0f);
    o.height = dot(o.n, origin_ws - t.a);
    o.holds = gn_plane_holds(plane, p_ws - t.a, magnitude);
    o.able = plane.size > 0.0f && !o.holds && !gn_occluder_below(t, p_ws, n_ws, magnitude) &&
             !(t.one_sided && o.height > 0.0f);
    o.hides = o.able && !gn_plane_near(plane, p_ws - t.a, n_ws, magnitude);
    return o;
}

// Whether the triangle's plane stands between the sample and the light (w = 1 a point, w = 0 the direction towards it).
GN_FN bool gn_plane_between(GnOcclusion o, GnOccluder t, vec3 origin_ws, vec4 light_ws) {
    vec3 l = vec3(light_ws);
    if (light_ws.w == 0.0f) {
        return o.height * dot(o.n, l) < 0.0f;
    }
    float end = dot(o.n, l - t.a);
    vec3 magnitude = max(max(abs(l), abs(l - origin_ws)), max(abs(t.a), max(abs(t.b), abs(t.c))));
    return o.height * end < 0.0f && abs(end) > gn_rounding(gn_near_ulps, o.n, magnitude);
}

// The signed shares of a direction's hit between the corners, not divided by their sum; all of one sign where it hits.
GN_FN vec3 gn_hit_shares(GnOccluderEdges edges, vec3 d) {
    return vec3(dot(d, edges.bc), dot(d, edges.ca), dot(d, edges.ab));
}
GN_FN bool gn_within(vec3 shares) {
    bool front = shares.x >= 0.0f && shares.y >= 0.0f && shares.z >= 0.0f;
    bool back = shares.x <= 0.0f && shares.y <= 0.0f && shares.z <= 0.0f;
    return front != back;
}

// From the rays' origin towards the light; of a sun as it is.
GN_FN vec3 gn_towards(vec3 origin_ws, vec4 light_ws) {
    return vec3(light_ws) - origin_ws * light_ws.w;
}

// Whether the triangle stands on the way to the light, for a sample that is not meant to lie on it; a mask is taken for whole.
GN_FN bool gn_in_the_way(GnOcclusion o, GnOccluder t, vec3 origin_ws, vec4 light_ws) {
    return gn_plane_between(o, t, origin_ws, light_ws) &&
           gn_within(gn_hit_shares(o.edges, gn_towards(origin_ws, light_ws)));
}

// What each triangle says of a sample and a light; what all have said tells whether the light is hidden. A sample does not know its
// triangle. Beside the border of one the rasterizer may give it another's plane: it lies a step of the rasterizer beyond the edge, and
// below the triangle that begins there by that step's share of the angle between both. The truth then takes the other one for its
// surface, the nearest along the normal; so a triangle above a sample that no surface holds is the sample's own, and hides nothing.
const uint gn_says_hidden = 1u;  // it hides the light
const uint gn_says_over = 2u;    // it would, if the sample lay on another surface
const uint gn_says_holds = 4u;   // the sample lies on it
GN_FN bool gn_hidden(uint said) {
    return (said & gn_says_hidden) != 0u || (said & (gn_says_over | gn_says_holds)) == (gn_says_over | gn_says_holds);
}
GN_FN uint gn_occluder_says(GnOccluder t, vec3 p_ws, vec3 n_ws, vec4 light_ws) {
    GnOcclusion o = gn_occlusion(t, p_ws, n_ws);
    vec3 origin_ws = gn_ray_origin(p_ws, n_ws);

    // The truth's question for the sample's surface: along the normal, so near, and within the triangle.
    vec3 magnitude = max(max(abs(p_ws), abs(t.a)), max(abs(t.b), abs(t.c)));
    float reach = gn_seat_ulps * gn_ulp * max(max(magnitude.x, magnitude.y), magnitude.z);
    float facing = abs(dot(o.n, n_ws));
    bool seat = facing > 0.99f && abs(dot(o.n, p_ws - t.a)) <= reach * facing && gn_within(gn_hit_shares(o.edges, n_ws));
    bool hides = o.able && gn_in_the_way(o, t, origin_ws, light_ws);
    return (seat && o.holds ? gn_says_holds : 0u) | (hides ? (seat ? gn_says_over : gn_says_hidden) : 0u);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
