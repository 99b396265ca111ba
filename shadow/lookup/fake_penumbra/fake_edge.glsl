// SPDX-License-Identifier: MIT
// How much of the light a receiver sees beside the edge of a hard shadow, by how far away the edge lies: as if what casts it were a
// half-plane. Compiles as GLSL and as C++ (the tests check its laws on the CPU).
// Penumbrae: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09], 5.2.1.
#ifndef GN_SHADOW_LOOKUP_FAKE_EDGE_GLSL
#define GN_SHADOW_LOOKUP_FAKE_EDGE_GLSL

#include "shadow/lookup/fake_penumbra/fake_penumbra.h"
#include "shadow/lookup/pcss/pcss_tap.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The share of the light that is seen beside a straight edge, `x` halves of the penumbra's width to its lit side: of a square that
// the edge is parallel to, and of a disc what is left of a chord.
GN_FN float gn_fake_ramp(bool square, float x) {
    float c = clamp(x, -1.0f, 1.0f);
    return square ? 0.5f + 0.5f * c : 1.0f - (acos(c) - c * sqrt(max(1.0f - c * c, 0.0f))) / 3.14159265f;
}

// Whether the light has an extent.
GN_FN bool gn_fake_has_size(GnLight light) {
    if (light.kind == uint(GN_LIGHT_RECTANGLE)) {
        return max(light.half_size.x, light.half_size.y) > 0.0f;
    }
    return (light.kind == uint(GN_LIGHT_DIRECTIONAL) ? light.angular_radius : light.radius) > 0.0f;
}

// Whether there are penumbrae at all; else the shadow is hard.
GN_FN bool gn_fake_spreads(GnLight light, GnFakePenumbraParams params) { return params.least > 0.0f || gn_fake_has_size(light); }

// Half the light as gn_extent_light has it; one without extent along an axis is a millionth as wide as it is far away.
GN_FN GnExtentLight gn_fake_light(GnLight light, vec3 p_ws) {
    bool far = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    float least = 1.0e-6f * (far ? 1.0f : max(length(vec3(light.position_ws) - p_ws), 1.0e-6f));
    GnLight wider = light;
    wider.radius = max(light.radius, least);
    wider.angular_radius = max(light.angular_radius, least);
    wider.half_size = max(light.half_size, vec2(least));
    return gn_extent_light(wider, p_ws);
}

// How far a point of the light, in halves of its extent, lies from its centre.
GN_FN float gn_fake_norm(bool square, vec2 q) { return square ? max(abs(q.x), abs(q.y)) : length(q); }

// Which point of the light sees the receiver where its map shows something `d_ts` away: q times the spread of what is there. The
// inverse of gn_extent_way, which moves along (right, up) q and divides by 1 + fall.q.
struct GnFakeAxes {
    vec2 x;  // q.x = dot(x, d_ts), before the division
    vec2 y;
    vec2 fall;
    bool square;
    float least;  // norm of q for each texture unit, at least
};

GN_FN GnFakeAxes gn_fake_axes(GnLookup at, GnExtentLight half_light) {
    vec2 right_ts = vec2(dot(at.projected.du_ws, half_light.right_ws), dot(at.projected.dv_ws, half_light.right_ws));
    vec2 up_ts = vec2(dot(at.projected.du_ws, half_light.up_ws), dot(at.projected.dv_ws, half_light.up_ws));
    float area = right_ts.x * up_ts.y - right_ts.y * up_ts.x;
    float large = length(right_ts) * length(up_ts);
    // Where the light's plane is seen edge-on the axes are taken for longer than they are.
    area = abs(area) > 1.0e-4f * large ? area : 1.0e-4f * max(large, 1.0e-30f);
    GnFakeAxes axes;
    axes.x = vec2(up_ts.y, -up_ts.x) / area;
    axes.y = vec2(-right_ts.y, right_ts.x) / area;
    axes.square = half_light.square;
    vec3 row_w = gn_row(at.view.cs_from_ws, 3);
    float w = gn_clip(at.view, at.receiver.p_ws).w;
    axes.fall = gn_bent(at.view) ? vec2(0.0f) : vec2(dot(row_w, half_light.right_ws), dot(row_w, half_light.up_ws)) / w;
    // The least singular value of a matrix is at least its determinant over its norm; of a square's norm 1 / sqrt(2) of that.
    float norm = sqrt(dot(axes.x, axes.x) + dot(axes.y, axes.y));
    axes.least = (axes.square ? 0.70710678f : 1.0f) / (abs(area) * norm);
    return axes;
}

GN_FN vec2 gn_fake_point(GnFakeAxes axes, vec2 d_ts) {
    vec2 q = vec2(dot(axes.x, d_ts), dot(axes.y, d_ts));
    return q / max(1.0f - dot(axes.fall, q), 0.1f);
}

// How many halves of the penumbra's width away an edge is that lies `steps` texels or pixels away, where the light's point that
// sees it has the norm `reach`, over the spread of what casts it. The half width is at least `least` and at most `most` of them.
GN_FN float gn_fake_distance(float steps, float reach, float spread, float least, float most) {
    if (steps <= 0.0f) {
        return 0.0f;
    }
    float half_width = steps * spread / max(reach, 1.0e-30f);
    return steps / max(clamp(half_width, min(least, most), most), 1.0e-30f);
}

// The way from a place to the nearest point of a texel, in texels.
GN_FN vec2 gn_fake_to_texel(vec2 place, ivec2 texel) {
    vec2 d = vec2(texel) + 0.5f - place;
    return sign(d) * max(abs(d) - 0.5f, vec2(0.0f));
}

// The way from a receiver to an edge's point on the picture, in the light's plane: q times the spread, as gn_fake_point.
GN_FN vec2 gn_fake_beside(GnLight light, GnExtentLight half_light, vec3 p_ws, vec3 edge_ws) {
    bool far = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    vec3 axis = gn_extent_axis(light, p_ws);
    vec3 ray_ws = far ? vec3(light.direction_ws) : edge_ws - vec3(light.position_ws);
    vec3 way_ws = edge_ws - p_ws;
    float along = dot(axis, ray_ws);
    way_ws = way_ws - ray_ws * (dot(axis, way_ws) / (abs(along) > 1.0e-6f ? along : 1.0e-6f));
    return vec2(dot(way_ws, half_light.right_ws) / dot(half_light.right_ws, half_light.right_ws),
                dot(way_ws, half_light.up_ws) / dot(half_light.up_ws, half_light.up_ws));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
