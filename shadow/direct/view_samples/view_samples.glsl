// SPDX-License-Identifier: MIT
// What an edge leaves of a light, as a line across it, and which view samples a triangle may hide any of it from.
// Compiles as GLSL and as C++.
//
// Based on: Eisemann, Decoret. Visibility Sampling on GPU and Applications. Eurographics 2007. [ED07]
// Based on: Sintorn, Eisemann, Assarsson. Sample Based Visibility for Soft Shadows using Alias-free Shadow Maps. EGSR 2008. [SEA08]
#ifndef GN_SHADOW_DIRECT_VIEW_SAMPLES_GLSL
#define GN_SHADOW_DIRECT_VIEW_SAMPLES_GLSL

#include "shadow/direct/view_samples/view_samples.h"
#include "shadow/geometry/occluder.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// A light as its points are spread over it: `centre_ws` (w = 1 a place, w = 0 the direction towards a sun's middle) and its
// axes, as long as it is wide; a point is centre + x X + y Y + z Z with coordinates of at most one half.
struct GnSampledLight {
    vec4 centre_ws;
    vec4 x_ws;
    vec4 y_ws;
    vec4 z_ws;  // null of flat lights
    int square; // 1: x and y reach one half each, 0: all together do
    int solid;  // 1: a sphere
};

// Products of three lengths, whose squares may be more than a float holds.
GN_FN float gn_length_of_cubes(vec3 v) {
    float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    return largest > 0.0f ? largest * length(v / largest) : 0.0f;
}

// The most that v changes from the light's middle to any of its points.
GN_FN float gn_light_reach(GnSampledLight light, vec3 v) {
    vec3 along = vec3(dot(v, vec3(light.x_ws)), dot(v, vec3(light.y_ws)), dot(v, vec3(light.z_ws)));
    return 0.5f * (light.square != 0 ? abs(along.x) + abs(along.y) : gn_length_of_cubes(along));
}

// A line across a flat light, or a plane through a sphere: the points with n . point + offset >= 0 are left of it.
struct GnLightLine {
    vec3 n;        // unit
    float offset;  // of the light's width
    float size;    // what n and offset were divided by; 0: no line
    float reach;   // offsets beyond which no point, or every one, is left of it
};
// Of the plane {l: l . edge = 0} through the receiver, for the light from there.
GN_FN GnLightLine gn_light_line(GnSampledLight light, vec3 edge, vec3 centre_from_p) {
    GnLightLine line;
    vec3 n = vec3(dot(edge, vec3(light.x_ws)), dot(edge, vec3(light.y_ws)), dot(edge, vec3(light.z_ws)));
    line.size = gn_length_of_cubes(n);
    float scale = line.size > 0.0f ? 1.0f / line.size : 0.0f;
    line.n = n * scale;
    line.offset = dot(edge, centre_from_p) * scale;
    line.reach = light.square != 0 ? 0.5f * (abs(line.n.x) + abs(line.n.y)) : 0.5f;
    return line;
}

const float gn_turn = 6.28318530718f;

// Largest offset in a left-sample map. [EASW09] section 5.3.3.2: half of a square's diagonal.
GN_FN float gn_left_range(GnSampledLight light) {
    return light.square != 0 ? 0.70710678f : 0.5f;
}

// Texels of a map around: of a flat light angles, of a sphere azimuths times elevations, half as many of these.
GN_FN int gn_left_around(GnSampledLight light, int angles) {
    return light.solid != 0 ? angles * (angles / 2) : angles;
}

// The texel of a line, counted offset by offset, for the next.
GN_FN int gn_left_texel(GnSampledLight light, GnLightLine line, int angles, int offsets) {
    float turn = atan(line.n.y, line.n.x) / gn_turn + 0.5f;
    int around = min(int(turn * float(angles)), angles - 1);
    if (light.solid != 0) {
        int rings = angles / 2;
        float rise = acos(clamp(line.n.z, -1.0f, 1.0f)) / (0.5f * gn_turn);
        around = around * rings + min(int(rise * float(rings)), rings - 1);
    }
    float across = (line.offset / gn_left_range(light) + 1.0f) * 0.5f;
    return around * offsets + clamp(int(across * float(offsets)), 0, offsets - 1);
}

// How far from the line that a texel stands for its other lines lie, of the light's width, at most: half a texel of the offset,
// and half a texel's turn at the light's rim. Of a square 0.71 / offsets + 2.23 / angles.
GN_FN float gn_left_error(GnSampledLight light, int angles, int offsets) {
    float turn = 0.5f * gn_turn / float(angles) * (light.solid != 0 ? 1.41421356f : 1.0f);
    return gn_left_range(light) * (1.0f / float(offsets) + turn);
}

// Lines and points agree to this part of the light's width; where rounding blurs a line further, its texel is not asked.
const float gn_left_blur = 0.001953125f;

// What rounding may move a line by, of the light's width.
GN_FN float gn_line_rounding(GnSampledLight light, GnLightLine line, vec3 edge, vec3 origin_ws, vec3 centre_from_p) {
    float far = length(centre_from_p) + light.centre_ws.w * (length(origin_ws) + length(vec3(light.centre_ws)));
    return line.size > 0.0f ? 4.0f * gn_ulp * length(edge) * far / line.size : 1.0e30f;
}

// A triangle, and where the light lies about its plane.
struct GnHider {
    vec3 a;
    vec3 b;
    vec3 c;
    vec3 n;         // unit; null where it has none
    float end_low;  // least height of a point of the light over its plane, and the greatest
    float end_high;
    float size;     // its coordinates' largest
};
GN_FN GnHider gn_hider(GnSampledLight light, vec3 a_ws, vec3 b_ws, vec3 c_ws) {
    GnHider t;
    t.a = a_ws;
    t.b = b_ws;
    t.c = c_ws;
    vec3 normal = cross(b_ws - a_ws, c_ws - a_ws);
    float area = length(normal);
    t.n = area > 0.0f ? normal / area : vec3(0.0f);
    vec3 magnitude = max(abs(a_ws), max(abs(b_ws), abs(c_ws)));
    t.size = max(magnitude.x, max(magnitude.y, magnitude.z));
    float end = dot(t.n, vec3(light.centre_ws) - a_ws * light.centre_ws.w);
    float reach = gn_light_reach(light, t.n);
    // Of a sun `end` is a number, else a length.
    float sizes = light.centre_ws.w > 0.0f ? t.size + length(vec3(light.centre_ws)) : 1.0f;
    float rounding = 16.0f * gn_ulp * sizes;
    t.end_low = end - reach - rounding;
    t.end_high = end + reach + rounding;
    return t;
}

GN_FN float gn_sum(vec3 v) {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

// Whether an edge keeps all of the light from being behind the triangle, from wherever in the box. The edge's plane is bilinear
// in the place p and the point l: with p = middle + d and l = centre + e
//
//     (l - p) . ((b - p) x (c - p)) = D . E + e . E + d . (D x (c - b) - E) + e . ((c - b) x d),   D . E its value at both middles
GN_FN bool gn_edge_clears(GnSampledLight light, float side, vec3 b, vec3 c, vec3 d_ws, vec3 half_ws, float rounding) {
    vec3 along = c - b;
    vec3 edge = cross(b, along);
    vec3 by_place = cross(d_ws, along) - light.centre_ws.w * edge;
    float most = gn_light_reach(light, edge) + dot(abs(by_place), half_ws);
    float wide = gn_sum(vec3(light.x_ws)) + gn_sum(vec3(light.y_ws)) + gn_sum(vec3(light.z_ws));
    most += 0.5f * wide * length(along) * length(half_ws);
    most += gn_sum(d_ws) * gn_sum(b) * (1.0e-6f * gn_sum(along) + rounding);
    return side * dot(d_ws, edge) + 1.0001f * most < 0.0f;
}

// Whether the triangle may hide any of the light from any place in a box; a box without extent is one sample.
GN_FN bool gn_may_hide(GnSampledLight light, GnHider t, vec3 low_ws, vec3 high_ws) {
    vec3 middle = 0.5f * (low_ws + high_ws);
    vec3 half_ws = 0.5f * (high_ws - low_ws);
    float height = dot(t.n, middle - t.a);
    float reach = dot(abs(t.n), half_ws);

    // Light and samples lie on two sides of its plane: 1 where the samples lie behind, -1 before, 0 where boxes of both cross.
    float size = t.size + gn_sum(middle) + gn_sum(half_ws);
    float slack = gn_below_ulps * gn_ulp * size;
    float side = t.end_low > 0.0f ? 1.0f : (t.end_high < 0.0f ? -1.0f : 0.0f);
    if (side == 0.0f) {
        side = height + reach < -slack ? 1.0f : (height - reach > slack ? -1.0f : 0.0f);
    }
    bool behind = side == 0.0f || side * height - reach < slack;

    // Rays rise from a hair above the sample.
    half_ws += 4.0f * gn_ulp * gn_sum(middle);
    vec3 d_ws = vec3(light.centre_ws) - middle * light.centre_ws.w;
    vec3 a = t.a - middle;
    vec3 b = t.b - middle;
    vec3 c = t.c - middle;
    float rounding = 4.0f * gn_ulp * size;
    bool clear = gn_edge_clears(light, side, a, b, d_ws, half_ws, rounding) ||
                 gn_edge_clears(light, side, b, c, d_ws, half_ws, rounding) ||
                 gn_edge_clears(light, side, c, a, d_ws, half_ws, rounding);
    return behind && (side == 0.0f || !clear);
}

// Axes in which boxes of samples are narrow: those of the light, with its direction for the last.
struct GnLightAxes {
    vec4 x_ws;  // unit
    vec4 y_ws;
    vec4 z_ws;
};
GN_FN vec3 gn_ls_from_ws(GnLightAxes axes, vec3 v_ws) {
    return vec3(dot(v_ws, vec3(axes.x_ws)), dot(v_ws, vec3(axes.y_ws)), dot(v_ws, vec3(axes.z_ws)));
}

// Nodes of a complete tree of four children, below and with one that `level` levels hang from.
GN_FN uint gn_tree_nodes(uint level) {
    return (4u << (2u * level)) / 3u;
}

// Where the tree's node over sample `first` stands, `level` levels above the samples, of `top` levels: each node before its
// children.
GN_FN uint gn_tree_node(uint first, uint level, uint top) {
    uint at = 0u;
    for (uint l = top; l > level; --l) {
        at += 1u + ((first >> (2u * (l - 1u))) & 3u) * gn_tree_nodes(l - 1u);
    }
    return at;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
