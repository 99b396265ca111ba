// SPDX-License-Identifier: MIT
// Maps whose rows stand apart by equal ratios of distance. Clip space is homogeneous, (x, y, w): columns are x / w as in any
// perspective, rows follow the logarithm of y / w, which is 1 on the first row and exp(-rate) on the last. A rate of 0 leaves rows
// that are y / w itself. Places on the map run from -1 to 1. Compiles as GLSL and as C++.
//
// Based on: Lloyd. Logarithmic Perspective Shadow Maps. University of North Carolina at Chapel Hill 2007. [Llo07]
// Departs from it: a triangle is bounded by a rectangle of the map, and every texel decides by homogeneous edge functions.
#ifndef GN_SHADOW_LOGARITHM_GLSL
#define GN_SHADOW_LOGARITHM_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// s = ln(z / z_n) / ln(z_f / z_n) of C 3.2.2.2, with z_n / z = y / w; and what x / w and y / w are at a place of the map.
GN_FN vec2 gn_log_place(vec3 p_cs, float rate) {
    vec2 p_ndc = vec2(p_cs.x, p_cs.y) / p_cs.z;
    return vec2(p_ndc.x, rate > 0.0f ? -2.0f * log(max(p_ndc.y, 1.0e-30f)) / rate - 1.0f : p_ndc.y);
}
GN_FN vec2 gn_log_ndc(vec2 place, float rate) {
    return vec2(place.x, rate > 0.0f ? exp(-0.5f * rate * (place.y + 1.0f)) : place.y);
}

// What a step over the rows, at a rate a row, is worth of the same at its beginning: (1 - exp(-rate step)) / rate, so that a
// plane's depth is the quotient of a perspective map in it; and back.
GN_FN float gn_log_step(float step, float rate) {
    float x = rate * step;
    // The difference of nearly equal numbers is its series: below a tenth to eight digits.
    return abs(x) < 0.1f ? step * (1.0f - 0.5f * x * (1.0f - x / 3.0f * (1.0f - 0.25f * x * (1.0f - 0.2f * x))))
                         : (1.0f - exp(-x)) / rate;
}
GN_FN float gn_log_unstep(float worth, float rate) {
    float x = rate * worth;
    return abs(x) < 0.01f ? worth * (1.0f + x * (0.5f + x * (1.0f / 3.0f + 0.25f * x)))
                          : -log(max(1.0f - x, 1.0e-30f)) / rate;
}

// Whether a point lies on the map's side of its first row and of its last, where y / w is `last`: both are at least 0 between them.
GN_FN vec2 gn_log_sides(vec3 p_cs, float last) { return vec2(p_cs.z - p_cs.y, p_cs.y - last * p_cs.z); }

// Grows a rectangle (min.xy, max.zw) of x / w and y / w by what of an edge lies between the first and the last row; `at_a` and
// `at_b` are the sides of its ends.
GN_FN vec4 gn_log_edge(vec4 box, vec3 a, vec3 b, vec2 at_a, vec2 at_b) {
    float first = 0.0f;
    float last = 1.0f;
    for (int i = 0; i < 2; ++i) {
        if (at_a[i] < 0.0f && at_b[i] < 0.0f) {
            return box;
        }
        float cut = at_a[i] / (at_a[i] - at_b[i]);
        first = at_a[i] < 0.0f ? max(first, cut) : first;
        last = at_b[i] < 0.0f ? min(last, cut) : last;
    }
    if (first > last) {
        return box;
    }
    for (int i = 0; i < 2; ++i) {
        vec3 p_cs = a + (b - a) * (i == 0 ? first : last);
        vec2 p_ndc = vec2(p_cs.x, p_cs.y) / max(p_cs.z, 1.0e-30f);
        box = vec4(min(box.x, p_ndc.x), min(box.y, p_ndc.y), max(box.z, p_ndc.x), max(box.w, p_ndc.y));
    }
    return box;
}

GN_FN float gn_log_least(vec3 v) { return min(v.x, min(v.y, v.z)); }

// A rectangle of the map around the image of a triangle; empty (min > max) where there is none.
GN_FN vec4 gn_log_bounds(vec3 a, vec3 b, vec3 c, float rate) {
    // Leave out what lies wholly behind the light or beyond one border. Before the light y is positive, or w where rows are even.
    float last = rate > 0.0f ? exp(-rate) : -1.0f;
    vec2 at_a = gn_log_sides(a, last);
    vec2 at_b = gn_log_sides(b, last);
    vec2 at_c = gn_log_sides(c, last);
    vec3 x = vec3(a.x, b.x, c.x);
    vec3 y = vec3(a.y, b.y, c.y);
    vec3 w = vec3(a.z, b.z, c.z);
    vec3 before = rate > 0.0f ? y : w;
    vec2 most = max(at_a, max(at_b, at_c));
    if (gn_log_least(-before) >= 0.0f || min(most.x, most.y) < 0.0f || gn_log_least(x - w) > 0.0f ||
        gn_log_least(-x - w) > 0.0f) {
        return vec4(1.0f, 1.0f, -1.0f, -1.0f);
    }

    // Where y and w are both 0 rows meet: a triangle that holds this point has an image without end. These weights of its corners
    // give the point, which it holds where none differs in sign.
    vec3 meet = cross(y, w);
    float room = 1.0e-5f * max(abs(meet.x), max(abs(meet.y), abs(meet.z)));
    if (gn_log_least(before) <= 0.0f && max(gn_log_least(meet), gn_log_least(-meet)) >= -room) {
        return vec4(-1.0f, -1.0f, 1.0f, 1.0f);
    }

    // Bound what of its edges lies between the rows. Cuts are rounded by the length of their edge, what lies there whole by its
    // last places.
    vec4 box = vec4(1.0e9f, 1.0e9f, -1.0e9f, -1.0e9f);
    box = gn_log_edge(box, a, b, at_a, at_b);
    box = gn_log_edge(box, b, c, at_b, at_c);
    box = gn_log_edge(box, c, a, at_c, at_a);
    if (box.x > box.z) {
        return box;
    }
    vec2 ends = vec2(gn_log_place(vec3(0.0f, box.y, 1.0f), rate).y, gn_log_place(vec3(0.0f, box.w, 1.0f), rate).y);
    vec2 least = min(at_a, min(at_b, at_c));
    float slack = min(least.x, least.y) < 0.0f ? 2.0e-3f : 2.0e-4f;
    return vec4(max(box.x - slack, -1.0f), max(min(ends.x, ends.y) - slack, -1.0f), min(box.z + slack, 1.0f),
                min(max(ends.x, ends.y) + slack, 1.0f));
}

// Twice the triangle's volume with the centre of projection: above 0 where its corners turn from x to y, seen by the light.
GN_FN float gn_log_facing(vec3 a, vec3 b, vec3 c) { return dot(a, cross(b + c, c - b)); }

// Barycentric coordinates in the world of what a triangle shows at a place, and 1; -1 where it misses [Llo07]: the point is a sum of
// the corners with these weights, and none may be negative. Neighbours decide about their common edge by the same number with
// opposite signs, so that no texel slips through.
GN_FN vec4 gn_log_hit(vec2 p_ndc, vec3 a, vec3 b, vec3 c) {
    vec3 p_cs = vec3(p_ndc.x, p_ndc.y, 1.0f);
    vec3 sides = vec3(dot(p_cs, cross(b + c, c - b)), dot(p_cs, cross(c + a, a - c)), dot(p_cs, cross(a + b, b - a)));
    sides = gn_log_facing(a, b, c) < 0.0f ? -sides : sides;
    float sum = sides.x + sides.y + sides.z;
    if (sides.x < 0.0f || sides.y < 0.0f || sides.z < 0.0f || sum <= 0.0f) {
        return vec4(0.0f, 0.0f, 0.0f, -1.0f);
    }
    return vec4(sides / sum, 1.0f);
}

// How a number that is linear over the triangle's plane, `corners` at its corners, changes with the place: it is N p / D p.
// Whether the place is on the triangle does not matter.
GN_FN vec2 gn_log_slope(vec2 p_ndc, vec3 a, vec3 b, vec3 c, vec3 corners, float rate) {
    vec3 of_a = cross(b + c, c - b);
    vec3 of_b = cross(c + a, a - c);
    vec3 of_c = cross(a + b, b - a);
    vec3 n = corners.x * of_a + corners.y * of_b + corners.z * of_c;
    vec3 d = of_a + of_b + of_c;
    float below = d.x * p_ndc.x + d.y * p_ndc.y + d.z;
    float value = (n.x * p_ndc.x + n.y * p_ndc.y + n.z) / below;
    vec2 change = (vec2(n.x, n.y) - value * vec2(d.x, d.y)) / below;
    return vec2(change.x, rate > 0.0f ? -0.5f * rate * p_ndc.y * change.y : change.y);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
