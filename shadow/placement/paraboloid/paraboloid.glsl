// SPDX-License-Identifier: MIT
// Two hemispheres, or the one that a light shines into.
// Based on: Brabec, Annen, Seidel. Shadow Mapping for Hemispherical and Omnidirectional Light Sources. CGI 2002. [BAS02]
#ifndef GN_SHADOW_PLACEMENT_PARABOLOID_GLSL
#define GN_SHADOW_PLACEMENT_PARABOLOID_GLSL

#include "shadow/placement/faces.glsl"
#include "shadow/placement/paraboloid/paraboloid.h"

GN_FN GnChoice gn_paraboloid_choose(GnReceiver receiver, GnParaboloidData data) {
    bool behind = dot(receiver.p_ws - vec3(data.eye_ws), vec3(data.axis_ws)) < 0.0f;
    return gn_only(behind && data.eye_ws.w > 0.5f ? 1 : 0);
}

#endif
