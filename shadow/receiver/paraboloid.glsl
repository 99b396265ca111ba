// SPDX-License-Identifier: MIT
// A hemisphere of directions on a disc: the parabolic mirror, which is the stereographic projection. Directions are in
// the light's frame, z along the mirror's axis; u = xy / (|p| + z) is 0 on the axis and 1 across it.
// Compiles as GLSL and as C++.
//
// Based on: Brabec, Annen, Seidel. Shadow Mapping for Hemispherical and Omnidirectional Light Sources. CGI 2002. [BAS02]
#ifndef GN_SHADOW_PARABOLOID_GLSL
#define GN_SHADOW_PARABOLOID_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

GN_FN vec2 gn_paraboloid(vec3 p_ls) { return vec2(p_ls.x, p_ls.y) / (length(p_ls) + p_ls.z); }

// The unit direction that falls on u.
GN_FN vec3 gn_paraboloid_ray(vec2 u) {
    float square = dot(u, u);
    return vec3(2.0f * u.x, 2.0f * u.y, 1.0f - square) / (1.0f + square);
}

// Whether the direction d of the great circle with normal n lies on its shorter arc from a to b.
GN_FN bool gn_paraboloid_on_arc(vec3 d, vec3 a, vec3 b, vec3 n) {
    return dot(cross(a, d), n) >= 0.0f && dot(cross(d, b), n) >= 0.0f;
}

// Grows a rectangle (min.xy, max.zw) by the image of the arc from a to b: a part of the circle around n.xy / n.z.
GN_FN vec4 gn_paraboloid_arc(vec4 box, vec3 a, vec3 b) {
    vec2 u = gn_paraboloid(a);
    box = vec4(min(box.x, u.x), min(box.y, u.y), max(box.z, u.x), max(box.w, u.y));
    vec3 n = cross(a + b, b - a);
    float size = length(n);
    if (abs(n.z) < 1.0e-3f * size) {
        return box;  // nearly a straight line
    }
    vec2 centre = vec2(n.x, n.y) / n.z;
    float radius = size / abs(n.z);
    if (gn_paraboloid_on_arc(gn_paraboloid_ray(centre - vec2(radius, 0.0f)), a, b, n)) {
        box.x = min(box.x, centre.x - radius);
    }
    if (gn_paraboloid_on_arc(gn_paraboloid_ray(centre - vec2(0.0f, radius)), a, b, n)) {
        box.y = min(box.y, centre.y - radius);
    }
    if (gn_paraboloid_on_arc(gn_paraboloid_ray(centre + vec2(radius, 0.0f)), a, b, n)) {
        box.z = max(box.z, centre.x + radius);
    }
    if (gn_paraboloid_on_arc(gn_paraboloid_ray(centre + vec2(0.0f, radius)), a, b, n)) {
        box.w = max(box.w, centre.y + radius);
    }
    return box;
}

// Whether an edge comes so close to the direction opposite the axis that its image leaves the plane.
GN_FN bool gn_paraboloid_far_behind(vec3 a, vec3 b) {
    vec3 middle = normalize(a) + normalize(b);
    return a.z < -0.5f * length(a) || middle.z < -0.5f * length(middle);
}

// A rectangle around the image of a triangle within |u| <= extent; empty (min > max) where there is none.
GN_FN vec4 gn_paraboloid_bounds(vec3 a, vec3 b, vec3 c, float extent) {
    // Directions beyond the map's corners are a convex cone: with all corners there the triangle is there.
    float corner = 2.0f * extent * extent;
    float limit = min((1.0f - corner) / (1.0f + corner), 0.0f);
    if (a.z < limit * length(a) && b.z < limit * length(b) && c.z < limit * length(c)) {
        return vec4(1.0f, 1.0f, -1.0f, -1.0f);
    }
    if (gn_paraboloid_far_behind(a, b) || gn_paraboloid_far_behind(b, c) || gn_paraboloid_far_behind(c, a)) {
        return vec4(-extent, -extent, extent, extent);
    }
    vec4 box = vec4(1.0e9f, 1.0e9f, -1.0e9f, -1.0e9f);
    box = gn_paraboloid_arc(box, a, b);
    box = gn_paraboloid_arc(box, b, c);
    box = gn_paraboloid_arc(box, c, a);
    float slack = 2.0e-3f;
    return vec4(max(box.x - slack, -extent), max(box.y - slack, -extent), min(box.z + slack, extent),
                min(box.w + slack, extent));
}

// Where the direction of u meets a triangle: barycentric coordinates and distance; distance < 0 where it misses.
// Neighbours decide about their common edge by the same number with opposite signs, so that no direction slips through.
GN_FN vec4 gn_paraboloid_hit(vec2 u, vec3 a, vec3 b, vec3 c) {
    vec3 d = gn_paraboloid_ray(u);
    vec3 n = cross(b - a, c - a);
    float facing = dot(a, n);
    vec3 sides = vec3(dot(d, cross(b + c, c - b)), dot(d, cross(c + a, a - c)), dot(d, cross(a + b, b - a)));
    sides = facing < 0.0f ? -sides : sides;
    float sum = sides.x + sides.y + sides.z;
    if (sides.x < 0.0f || sides.y < 0.0f || sides.z < 0.0f || sum <= 0.0f) {
        return vec4(0.0f, 0.0f, 0.0f, -1.0f);
    }
    float farthest = max(length(a), max(length(b), length(c)));
    float along = dot(d, n);
    float hit = abs(facing) <= farthest * abs(along) ? facing / along : farthest;
    return vec4(sides / sum, hit >= 0.0f ? hit : farthest);
}

// How the distance to a triangle's plane changes with u: the ray of u meets it at facing (1 + |u|^2) / (2 n.xy u + n.z (1 -
// |u|^2)). Whether u is on the triangle does not matter; where the distance above is a limit it does not change.
GN_FN vec2 gn_paraboloid_slope(vec2 u, vec3 a, vec3 b, vec3 c) {
    vec3 n = cross(b - a, c - a);
    float facing = dot(a, n);
    float farthest = max(length(a), max(length(b), length(c)));
    float square = dot(u, u);
    float divisor = 2.0f * (n.x * u.x + n.y * u.y) + n.z * (1.0f - square);
    if (abs(facing) * (1.0f + square) > farthest * abs(divisor)) {
        return vec2(0.0f);
    }
    vec2 change = 2.0f * (vec2(n.x, n.y) - n.z * u);
    return facing / divisor * (2.0f * u - (1.0f + square) / divisor * change);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
