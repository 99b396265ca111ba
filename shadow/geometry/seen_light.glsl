// SPDX-License-Identifier: MIT
// A light as a receiver sees it, and edges between them, projected onto it.
// Based on: Assarsson, Akenine-Moller. A Geometry-Based Soft Shadow Volume Algorithm Using Graphics Hardware. TOG 2003. [AA03]
// Departs from it: discs and suns beside squares.
//
// It compiles as GLSL and as C++.
#ifndef GN_SHADOW_GEOMETRY_SEEN_LIGHT_GLSL
#define GN_SHADOW_GEOMETRY_SEEN_LIGHT_GLSL

#include "shadow/receiver/across.glsl"
#include "shadow/scene/light.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The light's plane in coordinates in which the light is the unit disc, or the square from -1 to 1 (rectangles).
struct GnSeenLight {
    vec3 centre_ws;   // from the receiver
    vec3 forward_ws;  // unit: out of the light's plane, away from the receiver
    vec3 x_ws, y_ws;  // the plane's axes, divided by the light's half sizes
    float height;     // of the plane above the receiver, along forward_ws
};

// Half of the light's widths: metres, or the tangent of the sun's radius at a height of 1.
GN_FN vec2 gn_light_half_size(GnLight light) {
    return light.kind == uint(GN_LIGHT_RECTANGLE)     ? light.half_size
           : light.kind == uint(GN_LIGHT_DIRECTIONAL) ? vec2(tan(light.angular_radius))
                                                      : vec2(light.radius);
}

// The light of some size from a receiver. A sphere is the disc in which the receiver sees it, larger than its own radius by
// 1 / sqrt(1 - (r / d)^2); V of that disc is uniform over its area, of the sphere over the cone: they differ by (r / d)^2.
GN_FN GnSeenLight gn_seen_light(GnLight light, vec3 p_ws) {
    GnSeenLight seen;
    bool sun = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    seen.centre_ws = sun ? -vec3(light.direction_ws) : vec3(light.position_ws) - p_ws;
    seen.forward_ws = light.kind == uint(GN_LIGHT_POINT) ? normalize(seen.centre_ws) : -vec3(light.direction_ws);
    vec2 size = gn_light_half_size(light);
    if (light.kind == uint(GN_LIGHT_POINT)) {
        float sine2 = light.radius * light.radius / dot(seen.centre_ws, seen.centre_ws);
        size /= sqrt(max(1.0f - sine2, 1.0e-3f));
    }
    vec3 x = vec3(light.right_ws);
    vec3 y = vec3(light.up_ws);
    if (light.kind != uint(GN_LIGHT_RECTANGLE)) {
        gn_across(seen.forward_ws, x, y);
    }
    seen.x_ws = x / size.x;
    seen.y_ws = y / size.y;
    seen.height = dot(seen.forward_ws, seen.centre_ws);
    return seen;
}

// Cuts the segment (from the receiver) to what lies between receiver and light: away from both planes by a little, where
// projections end. False where nothing is left.
GN_FN bool gn_between(GnSeenLight seen, bool sun, GN_INOUT(vec3) a_ws, GN_INOUT(vec3) b_ws) {
    float low = 1.0e-4f * (sun ? length(a_ws) + length(b_ws) : seen.height);
    float high = sun ? 1.0e30f : seen.height * (1.0f - 1.0e-4f);
    float ha = dot(a_ws, seen.forward_ws);
    float hb = dot(b_ws, seen.forward_ws);
    if (max(ha, hb) <= low || min(ha, hb) >= high) {
        return false;
    }
    vec3 along = b_ws - a_ws;
    float rise = hb - ha;
    float t0 = 0.0f;
    float t1 = 1.0f;
    if (rise != 0.0f) {
        float at_low = (low - ha) / rise;
        float at_high = (high - ha) / rise;
        t0 = max(t0, min(at_low, at_high));
        t1 = min(t1, max(at_low, at_high));
    }
    b_ws = a_ws + along * t1;
    a_ws = a_ws + along * t0;
    return t1 > t0;
}

// A point between receiver and light, from the receiver, seen on the light's plane.
GN_FN vec2 gn_on_light(GnSeenLight seen, vec3 e_ws) {
    vec3 at_ws = e_ws * (seen.height / dot(e_ws, seen.forward_ws)) - seen.centre_ws;
    return vec2(dot(at_ws, seen.x_ws), dot(at_ws, seen.y_ws));
}

GN_FN float gn_cross2(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Cuts a segment to the unit disc, or to the square; false where it lies outside.
GN_FN bool gn_cut_to_light(bool square, GN_INOUT(vec2) a, GN_INOUT(vec2) b) {
    vec2 d = b - a;
    float t0 = 0.0f;
    float t1 = 1.0f;
    if (square) {
        for (int i = 0; i < 2; ++i) {
            float at = i == 0 ? a.x : a.y;
            float step = i == 0 ? d.x : d.y;
            if (step == 0.0f) {
                t1 = abs(at) > 1.0f ? -1.0f : t1;
            } else {
                float ta = (-1.0f - at) / step;
                float tb = (1.0f - at) / step;
                t0 = max(t0, min(ta, tb));
                t1 = min(t1, max(ta, tb));
            }
        }
        b = clamp(a + d * t1, vec2(-1.0f), vec2(1.0f));
        a = clamp(a + d * t0, vec2(-1.0f), vec2(1.0f));
        return t1 > t0;
    }
    // From the foot of the perpendicular: an end may be so far off that steps from there say nothing.
    float dd = dot(d, d);
    float c = gn_cross2(a, d);
    float root = dd - c * c;
    if (root <= 0.0f) {
        return false;
    }
    vec2 foot = vec2(d.y, -d.x) * (c / dd);
    float half_chord = sqrt(root) / dd;
    t0 = -dot(a, d) / dd - half_chord;
    t1 = t0 + 2.0f * half_chord;
    a = t0 > 0.0f ? foot - d * half_chord : a;
    b = t1 < 1.0f ? foot + d * half_chord : b;
    return min(t1, 1.0f) > max(t0, 0.0f);
}

// Area of the square from -1 to 1 between the x axis and a direction, turning left, of 4 in all: by eighths of a turn tangents
// grow it evenly.
GN_FN float gn_square_sector(vec2 d) {
    float ax = abs(d.x);
    float ay = abs(d.y);
    if (ax >= ay) {
        float t = d.y / (ax > 0.0f ? d.x : 1.0f);
        return (d.x >= 0.0f ? (d.y >= 0.0f ? 0.0f : 4.0f) : 2.0f) + 0.5f * t;
    }
    float t = -d.x / d.y;
    return (d.y > 0.0f ? 1.0f : 3.0f) + 0.5f * t;
}

// Share of the light that lies beyond the segment, seen from its middle: the sector between the ends, without the triangle of
// the middle and both. Both ends lie within the light. [AA03] section 3.3
GN_FN float gn_beyond(bool square, vec2 a, vec2 b) {
    float cross_ab = gn_cross2(a, b);
    if (square) {
        float turn = abs(gn_square_sector(b) - gn_square_sector(a));
        float sector = min(turn, 4.0f - turn);
        return max(sector - 0.5f * abs(cross_ab), 0.0f) / 4.0f;
    }
    float angle = atan(abs(cross_ab), dot(a, b));
    return max(0.5f * angle - 0.5f * abs(cross_ab), 0.0f) / 3.14159265f;
}

// On which side of the plane through edge and light a point is: 1 on the lit one, -1 on that of the shadow. The edge runs so
// that its volume's side is seen from outside as a, a at infinity, b at infinity, b.
GN_FN float gn_lit_side(vec3 a_ws, vec3 b_ws, vec3 centre_ws) {
    // From the receiver: dot(p - a, cross(a - C, b - a)) with p = 0.
    return -dot(a_ws, cross(a_ws - centre_ws, b_ws - a_ws)) > 0.0f ? 1.0f : -1.0f;
}
GN_FN float gn_lit_side_of_sun(vec3 a_ws, vec3 b_ws, vec3 to_sun_ws) {
    return -dot(a_ws, cross(-to_sun_ws, b_ws - a_ws)) > 0.0f ? 1.0f : -1.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
