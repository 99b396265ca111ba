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
// How far a view sample may be from its own surface, and what rounding leaves of an edge of it, in units of its coordinates.
const float gn_own_ulps = 64.0f;
const float gn_near_ulps = 4.0f;
const float gn_below_ulps = 16.0f;

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

// What the sample's own surface, and all that lies on or below it, cannot hide: `t` is left out for it, whatever the light.
GN_FN bool gn_occluder_own(GnOccluder t, vec3 n_t, vec3 p_ws, vec3 n_ws, vec3 magnitude) {
    float height = abs(dot(n_t, p_ws - t.a));
    float own = abs(dot(n_t, n_ws)) > 0.99f ? gn_own_ulps : gn_near_ulps;
    float above = max(max(dot(n_ws, t.a - p_ws), dot(n_ws, t.b - p_ws)), dot(n_ws, t.c - p_ws));
    return height <= gn_rounding(own, n_t, magnitude) || above <= gn_rounding(gn_below_ulps, n_ws, magnitude);
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
    bool hides;   // whether it can hide anything
};
GN_FN GnOcclusion gn_occlusion(GnOccluder t, vec3 p_ws, vec3 n_ws) {
    vec3 origin_ws = gn_ray_origin(p_ws, n_ws);
    vec3 normal = cross(t.b - t.a, t.c - t.a);
    float size = length(normal);
    vec3 magnitude = max(max(abs(p_ws), abs(t.a)), max(abs(t.b), abs(t.c)));
    GnOcclusion o;
    o.edges = gn_occluder_edges(t, origin_ws);
    o.n = size > 0.0f ? normal / size : vec3(0.0f);
    o.height = dot(o.n, origin_ws - t.a);
    o.hides = size > 0.0f && !gn_occluder_own(t, o.n, p_ws, n_ws, magnitude) && !(t.one_sided && o.height > 0.0f);
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

// Whether the triangle hides the light from the sample; a mask is taken for whole.
GN_FN bool gn_occluder_hides(GnOccluder t, vec3 p_ws, vec3 n_ws, vec4 light_ws) {
    GnOcclusion o = gn_occlusion(t, p_ws, n_ws);
    vec3 origin_ws = gn_ray_origin(p_ws, n_ws);
    return o.hides && gn_plane_between(o, t, origin_ws, light_ws) &&
           gn_within(gn_hit_shares(o.edges, gn_towards(origin_ws, light_ws)));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
