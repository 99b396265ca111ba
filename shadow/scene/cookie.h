// SPDX-License-Identifier: MIT
// Based on: Segal, Korobkin, van Widenfelt, Foran, Haeberli. Fast Shadows and Lighting Effects Using Texture Mapping. SIGGRAPH
// 1992. [SKB92]
//
// A picture in front of a light, as a slide in a projector: it belongs to the light as its colour does, and shadows know
// nothing of it.
#ifndef GN_SHADOW_SCENE_COOKIE_H
#define GN_SHADOW_SCENE_COOKIE_H

#include "shadow/scene/light.h"

#ifdef __cplusplus
using glm::acos;
using glm::atan;
using glm::clamp;
using glm::cross;
using glm::sqrt;
#endif

/// Which lights may have one: those whose rays do not cross, with a way through the picture. A spot's cone is narrower than a half
/// space. Rays of a rectangle cross at every place, into a half space: no picture is thrown by it.
GN_FN bool gn_takes_cookie(GnLight light) {
    return light.kind == uint(GN_LIGHT_POINT) || light.kind == uint(GN_LIGHT_DIRECTIONAL) ||
           (light.kind == uint(GN_LIGHT_SPOT) && light.cos_outer > 0.0f);
}

/// Where the light through the picture meets p: texture coordinates from its upper left corner. A spot's picture fills the square around its outer
/// cone, right and up as its right_ws and up_ws are across its direction; a point's is a map of longitude and latitude, the middle
/// towards -z, the top upwards. A sun's is thrown along its direction, twice half_size wide and high, metres, and lies beside itself
/// without end; its middle falls on position_ws.
GN_FN vec2 gn_cookie_place(GnLight light, vec3 p_ws) {
    vec3 off_ws = p_ws - vec3(light.position_ws);
    vec3 way_ws = normalize(off_ws);
    if (light.kind == uint(GN_LIGHT_POINT)) {
        return vec2(0.5f + atan(way_ws.x, -way_ws.z) / 6.2831853f, acos(clamp(way_ws.y, -1.0f, 1.0f)) / 3.14159265f);
    }
    vec3 axis_ws = vec3(light.direction_ws);
    vec3 right_ws = vec3(light.right_ws) - axis_ws * dot(axis_ws, vec3(light.right_ws));
    if (dot(right_ws, right_ws) < 1.0e-6f) {
        right_ws = cross(axis_ws, vec3(light.up_ws));
    }
    right_ws = normalize(right_ws);
    vec3 up_ws = cross(right_ws, axis_ws);
    if (light.kind == uint(GN_LIGHT_DIRECTIONAL)) {
        return vec2(0.5f + 0.5f * dot(off_ws, right_ws) / light.half_size.x,
                    0.5f - 0.5f * dot(off_ws, up_ws) / light.half_size.y);
    }
    float slope = sqrt(1.0f - light.cos_outer * light.cos_outer) / light.cos_outer;
    float reach = 2.0f * slope * dot(way_ws, axis_ws);
    return vec2(0.5f + dot(way_ws, right_ws) / reach, 0.5f - dot(way_ws, up_ws) / reach);
}

#endif
