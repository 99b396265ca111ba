// SPDX-License-Identifier: MIT
// The light as the receiver sees it, and where what a map holds is seen before it: projected from the receiver back onto the
// light's plane.
// Based on: Guennebaud, Barthe, Paulin. Real-time Soft Shadow Mapping by Backprojection. EGSR 2006. [GBP06]
// Departs from it: vertices are projected one by one, so that neither the map nor a texel's depth need be parallel to the
// light; spheres and suns are discs across the receiver's rays.
#ifndef GN_SHADOW_BACKPROJECTION_LIGHT_PLANE_GLSL
#define GN_SHADOW_BACKPROJECTION_LIGHT_PLANE_GLSL

#include "shadow/receiver/across.glsl"
#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// A point x of the light is centre + x.x right + x.y up, x in [-1,1]^2 or in the unit disc; of a sun a direction, whose part
// along `toward` is 1.
struct GnBackLight {
    vec3 p_ws;       // the receiver
    vec3 centre_ws;  // from the receiver
    vec3 right_ws;
    vec3 up_ws;
    vec3 toward_ws;  // across the light, unit
    float height;    // of the light's plane over the receiver, metres; of a sun 1
    bool disc;
    bool far;
};

// Half the width of the disc through a sphere's centre that the receiver sees where it sees the sphere. A receiver within the
// sphere, or nearly so, sees a wide disc.
GN_FN float gn_back_silhouette(float radius, float distance) {
    float share = min(radius / max(distance, 1.0e-6f), 0.95f);
    return radius / sqrt(1.0f - share * share);
}

GN_FN bool gn_back_has_size(GnLight light) {
    if (light.kind == uint(GN_LIGHT_RECTANGLE)) {
        return max(light.half_size.x, light.half_size.y) > 0.0f;
    }
    return (light.kind == uint(GN_LIGHT_DIRECTIONAL) ? light.angular_radius : light.radius) > 0.0f;
}

// A light without size is a millionth as wide as it is far away.
GN_FN GnBackLight gn_back_light(GnLight light, vec3 p_ws) {
    GnBackLight result;
    result.p_ws = p_ws;
    result.disc = light.kind != uint(GN_LIGHT_RECTANGLE);
    result.far = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    bool turned = light.kind == uint(GN_LIGHT_POINT);
    result.centre_ws = result.far ? -vec3(light.direction_ws) : vec3(light.position_ws) - p_ws;
    result.toward_ws = turned ? gn_to_light(light, p_ws) : -vec3(light.direction_ws);
    result.height = result.far ? 1.0f : max(dot(result.toward_ws, result.centre_ws), 1.0e-6f);
    float least = 1.0e-6f * result.height;
    if (!result.disc) {
        vec2 half_size = max(vec2(light.half_size), max(least, 1.0e-4f * max(light.half_size.x, light.half_size.y)));
        result.right_ws = vec3(light.right_ws) * half_size.x;
        result.up_ws = vec3(light.up_ws) * half_size.y;
        return result;
    }
    gn_across(result.toward_ws, result.right_ws, result.up_ws);
    float radius = result.far ? tan(light.angular_radius) : light.radius;
    radius = max(turned ? gn_back_silhouette(radius, result.height) : radius, least);
    result.right_ws = result.right_ws * radius;
    result.up_ws = result.up_ws * radius;
    return result;
}

// The same light, so many times as large.
GN_FN GnBackLight gn_back_scaled(GnBackLight light, float factor) {
    light.right_ws = light.right_ws * factor;
    light.up_ws = light.up_ws * factor;
    return light;
}

// What a view's texels are in the light's plane as the receiver sees it. A point q of the world, from the receiver, is seen
// before x = base + n.xy / n.z of the light, n = (right (q - p), up (q - p), toward (q - p)). A map holds, at uv and depth z, the
// point start(uv) + t way(uv), both linear in uv, t what reaches z; n times `start`'s own divisor is taken of it.
struct GnBackRays {
    vec2 base;
    vec3 start, start_u, start_v;
    vec3 way, way_u, way_v;
    vec3 divisor;      // of the start: constant, along u, along v
    vec3 start_depth;  // times the divisor
    vec3 way_depth;    // depth along the way
    float height;      // n.z of the light's plane; above it nothing hides the light
    float least;       // least n.z
};

// Coordinates in the light's plane of a way from the receiver.
GN_FN vec3 gn_back_in_plane(GnBackLight light, vec3 way_ws) {
    return vec3(dot(light.right_ws, way_ws) * light.height / dot(light.right_ws, light.right_ws),
                dot(light.up_ws, way_ws) * light.height / dot(light.up_ws, light.up_ws), dot(light.toward_ws, way_ws));
}

GN_FN GnBackRays gn_back_rays(GnLightView view, GnBackLight light) {
    GnBackRays rays;
    vec3 from_centre = gn_back_in_plane(light, -light.centre_ws);
    rays.base = light.far ? vec2(0.0f) : vec2(from_centre.x, from_centre.y) / light.height;
    rays.height = light.far ? 1.0e30f : light.height;
    rays.least = light.far ? 1.0e-7f * view.metres_per_depth : 1.0e-6f * light.height;

    vec3 axis = vec3(view.depth_from_ws);
    float offset = view.depth_from_ws.w;
    // ndc = (uv - rect.xy) / rect.zw * 2 - 1
    vec2 per_ts = 2.0f / vec2(view.rect_ts.z, view.rect_ts.w);
    vec2 first_ndc = -1.0f - vec2(view.rect_ts.x, view.rect_ts.y) * per_ts;
    if (view.eye_ws.w > 0.5f) {
        // All rays start in the eye, and lie in the planes of points with equal x and with equal y.
        vec3 row_x = gn_row(view.cs_from_ws, 0);
        vec3 row_y = gn_row(view.cs_from_ws, 1);
        vec3 row_w = gn_row(view.cs_from_ws, 3);
        vec3 u = cross(row_y, row_w);
        vec3 v = cross(row_w, row_x);
        vec3 o = cross(row_x, row_y) + first_ndc.x * u + first_ndc.y * v;
        u = u * per_ts.x;
        v = v * per_ts.y;
        vec3 eye_ws = vec3(view.eye_ws);
        rays.start = gn_back_in_plane(light, eye_ws - light.p_ws);
        rays.start_u = vec3(0.0f);
        rays.start_v = vec3(0.0f);
        rays.divisor = vec3(1.0f, 0.0f, 0.0f);
        rays.start_depth = vec3(dot(axis, eye_ws) + offset, 0.0f, 0.0f);
        rays.way = gn_back_in_plane(light, o);
        rays.way_u = gn_back_in_plane(light, u);
        rays.way_v = gn_back_in_plane(light, v);
        rays.way_depth = vec3(dot(axis, o), dot(axis, u), dot(axis, v));
        return rays;
    }
    // All rays go the same way, from their points at clip depth 1/2.
    vec4 along_u = view.ws_from_cs[0] * per_ts.x;
    vec4 along_v = view.ws_from_cs[1] * per_ts.y;
    vec4 origin = view.ws_from_cs[2] * 0.5f + view.ws_from_cs[3] + view.ws_from_cs[0] * first_ndc.x +
                  view.ws_from_cs[1] * first_ndc.y;
    float side = origin.w + 0.5f * (along_u.w + along_v.w) < 0.0f ? -1.0f : 1.0f;
    origin = origin * side;
    along_u = along_u * side;
    along_v = along_v * side;
    rays.start = gn_back_in_plane(light, vec3(origin) - light.p_ws * origin.w);
    rays.start_u = gn_back_in_plane(light, vec3(along_u) - light.p_ws * along_u.w);
    rays.start_v = gn_back_in_plane(light, vec3(along_v) - light.p_ws * along_v.w);
    rays.divisor = vec3(origin.w, along_u.w, along_v.w);
    rays.start_depth = vec3(dot(axis, vec3(origin)) + offset * origin.w, dot(axis, vec3(along_u)) + offset * along_u.w,
                            dot(axis, vec3(along_v)) + offset * along_v.w);
    rays.way = gn_back_in_plane(light, vec3(view.eye_ws));
    rays.way_u = vec3(0.0f);
    rays.way_v = vec3(0.0f);
    rays.way_depth = vec3(dot(axis, vec3(view.eye_ws)), 0.0f, 0.0f);
    return rays;
}

GN_FN float gn_back_linear(vec3 form, vec2 uv_ts) { return form.x + form.y * uv_ts.x + form.z * uv_ts.y; }

// What a map holds at uv and depth z, in the light's plane: n, and the divisor that it is a multiple of.
GN_FN vec4 gn_back_point(GnBackRays rays, vec2 uv_ts, float depth) {
    float divisor = gn_back_linear(rays.divisor, uv_ts);
    float t = (depth * divisor - gn_back_linear(rays.start_depth, uv_ts)) / gn_back_linear(rays.way_depth, uv_ts);
    vec3 start = rays.start + rays.start_u * uv_ts.x + rays.start_v * uv_ts.y;
    vec3 way = rays.way + rays.way_u * uv_ts.x + rays.way_v * uv_ts.y;
    return vec4(start + t * way, divisor);
}

// Where the receiver sees it before the light.
GN_FN vec2 gn_back_seen(GnBackRays rays, vec4 n) {
    return rays.base + vec2(n.x, n.y) / max(n.z, rays.least * n.w);
}

// Whether it lies between the receiver and the light's plane.
GN_FN bool gn_back_between(GnBackRays rays, vec4 n) { return n.z > rays.least * n.w && n.z < rays.height * n.w; }

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
