// SPDX-License-Identifier: MIT
// Based on: Assarsson, Akenine-Moller. A Geometry-Based Soft Shadow Volume Algorithm Using Graphics Hardware. TOG 2003. [AA03]
// Based on: Forest, Barthe, Paulin. Realistic Soft Shadows by Penumbra-Wedges Blending. Graphics Hardware 2006. [FBP06]
//
// What an edge hides of a light, and the table of it; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_SOFT_VOLUMES_GLSL
#define GN_SHADOW_DIRECT_SOFT_VOLUMES_GLSL

#include "shadow/direct/soft_volumes/soft_volumes.h"
#include "shadow/geometry/seen_light.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// An edge on the light, both ends within it; 0 where it hides nothing, else the sign of the half-wedge that the receiver is in:
// 1 where the light's centre is beside the caster and more is hidden than the hard shadow says, -1 where less is.
GN_FN float gn_soft_volumes_edge(GnLight light, vec3 p_ws, vec3 a_ws, vec3 b_ws, GN_OUT(vec2) a, GN_OUT(vec2) b) {
    GnSeenLight seen = gn_seen_light(light, p_ws);
    bool sun = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    vec3 from_a = a_ws - p_ws;
    vec3 from_b = b_ws - p_ws;
    float side = sun ? gn_lit_side_of_sun(from_a, from_b, seen.centre_ws) : gn_lit_side(from_a, from_b, seen.centre_ws);
    a = vec2(0.0f);
    b = vec2(0.0f);
    if (!gn_between(seen, sun, from_a, from_b)) {
        return 0.0f;
    }
    a = gn_on_light(seen, from_a);
    b = gn_on_light(seen, from_b);
    return gn_cut_to_light(light.kind == uint(GN_LIGHT_RECTANGLE), a, b) ? side : 0.0f;
}

// Cuts a segment to a quarter of the plane, x and y of these signs; false where it lies in others.
GN_FN bool gn_soft_volumes_quarter(vec2 signs, GN_INOUT(vec2) a, GN_INOUT(vec2) b) {
    for (int i = 0; i < 2; ++i) {
        float ha = i == 0 ? signs.x * a.x : signs.y * a.y;
        float hb = i == 0 ? signs.x * b.x : signs.y * b.y;
        if (ha <= 0.0f && hb <= 0.0f) {
            return false;
        }
        vec2 cut = a + (b - a) * (ha / (ha - hb));
        a = ha < 0.0f ? cut : a;
        b = hb < 0.0f ? cut : b;
    }
    return true;
}

// Whether a place lies on the light's border.
GN_FN bool gn_soft_volumes_on_border(bool square, vec2 p) {
    return (square ? max(abs(p.x), abs(p.y)) : sqrt(dot(p, p))) > 0.999f;
}

// The box (low.xy, -high.xy) around what a segment bounds on the light: its ends, and where one lies on the border, so that the
// caster goes on outside, the border beyond the segment as well. Boxes of several segments join by their minimum.
GN_FN vec4 gn_soft_volumes_box(bool square, vec2 a, vec2 b) {
    vec4 box = min(vec4(a.x, a.y, -a.x, -a.y), vec4(b.x, b.y, -b.x, -b.y));
    if (!gn_soft_volumes_on_border(square, a) && !gn_soft_volumes_on_border(square, b)) {
        return box;
    }
    // Eight places of the border, of which those in the sector count: corners and middles of the sides.
    float turn = gn_cross2(a, b) >= 0.0f ? 1.0f : -1.0f;
    for (int i = 0; i < 8; ++i) {
        float angle = 0.78539816f * float(i);
        vec2 p = vec2(cos(angle), sin(angle));
        p *= square ? 1.0f / max(abs(p.x), abs(p.y)) : 1.0f;
        bool within = turn * gn_cross2(a, p) >= 0.0f && turn * gn_cross2(p, b) >= 0.0f;
        box = within ? min(box, vec4(p.x, p.y, -p.x, -p.y)) : box;
    }
    return box;
}

// The share of the light that a box holds; it may be a little more than what of it lies on a disc.
GN_FN float gn_soft_volumes_box_share(bool square, vec4 box) {
    float area = max(-box.z - box.x, 0.0f) * max(-box.w - box.y, 0.0f);
    return min(area / (square ? 4.0f : 3.14159265f), 1.0f);
}

// V where the box around all that edges bound holds this share: one before the other, casters hide no more than it, nor do
// they show more. [FBP06] section 4.3
GN_FN float gn_soft_volumes_bounded(float hard, float hidden, float share) {
    return hard > 0.5f ? 1.0f - clamp(hidden, 0.0f, share) : clamp(-hidden, 0.0f, share);
}

// V from what the hard shadow says and what edges add to what is hidden.
GN_FN float gn_soft_volumes_light(float hard, float hidden) {
    return clamp(hard - hidden, 0.0f, 1.0f);
}

// The same by quarters of the light, of which each is hidden at most whole. [FBP06] section 4
GN_FN float gn_soft_volumes_light4(float hard, vec4 hidden) {
    vec4 v = clamp(vec4(hard) - 4.0f * hidden, vec4(0.0f), vec4(1.0f));
    return 0.25f * (v.x + v.y + v.z + v.w);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
