// SPDX-License-Identifier: MIT
// Based on: Blinn. Me and My (Fake) Shadow. IEEE Computer Graphics and Applications 1988. [Bli88]
//
// The projection onto a plane; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_GEOMETRY_FLATTENED_GLSL
#define GN_SHADOW_GEOMETRY_FLATTENED_GLSL

#include "base/shared.h"

// One receiver plane and the light above it.
struct GnFlattening {
    mat4 cs_from_ws;  ///< of what is drawn into: the camera's, or a map of the plane
    vec4 light_ws;    ///< w = 1: a point; w = 0: the direction towards it
    vec4 plane_ws;    ///< unit normal and offset; the light is on its positive side
    float tolerance;  ///< metres
};

// Height of a homogeneous point above the plane; of a direction, its component along the normal.
GN_FN float gn_plane_height(vec4 plane_ws, vec4 p_ws) {
    return dot(plane_ws, p_ws);
}

// Where the line from the light through p meets the plane, homogeneous; w > 0 for points between both.
// [AHH18] eq. 7.4, multiplied out: M p = (light height) p - (height of p) light.
GN_FN vec4 gn_plane_project(vec4 plane_ws, vec4 light_ws, vec3 p_ws) {
    float light_height = gn_plane_height(plane_ws, light_ws);
    float height = gn_plane_height(plane_ws, vec4(p_ws, 1.0f));
    return light_height * vec4(p_ws, 1.0f) - height * light_ws;
}

// Whether a view sample lies on the plane.
GN_FN bool gn_on_plane(vec4 plane_ws, float tolerance, vec3 p_ws, vec3 n_ws) {
    float height = gn_plane_height(plane_ws, vec4(p_ws, 1.0f));
    return abs(height) <= tolerance && abs(dot(n_ws, vec3(plane_ws))) > 0.9999f;
}

#endif
