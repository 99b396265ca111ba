// SPDX-License-Identifier: MIT
// Two hemispheres, or the one that a light shines into.
// Based on: Brabec, Annen, Seidel. Shadow Mapping for Hemispherical and Omnidirectional Light Sources. CGI 2002. [BAS02]
#ifndef GN_SHADOW_PLACEMENT_PARABOLOID_GLSL
#define GN_SHADOW_PLACEMENT_PARABOLOID_GLSL

#include "shadow/placement/faces.glsl"

// data.values[0].xyz: the light's position; w = 1 when there is a second hemisphere. data.values[1].xyz: the axis of the
// first.
GN_FN GnChoice gn_paraboloid_choose(GnReceiver receiver, GnPlacementData data) {
    bool behind = dot(receiver.p_ws - vec3(data.values[0]), vec3(data.values[1])) < 0.0f;
    return gn_only(behind && data.values[0].w > 0.5f ? 1 : 0);
}

#endif
