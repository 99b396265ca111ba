// SPDX-License-Identifier: MIT
// Six views around the light; the receiver's is the face it lies behind.
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
#ifndef GN_SHADOW_PLACEMENT_CUBE_GLSL
#define GN_SHADOW_PLACEMENT_CUBE_GLSL

#include "shadow/receiver.glsl"

// data.values[0].xyz: the light's position. Faces in the order +x -x +y -y +z -z. Each face's view is a little wider
// than 90 degrees, so that a kernel at its border still reads its own face: no seam.
GN_FN GnChoice gn_cube_choose(GnReceiver receiver, GnPlacementData data) {
    vec3 d_ws = receiver.p_ws - vec3(data.values[0]);
    vec3 a = vec3(abs(d_ws.x), abs(d_ws.y), abs(d_ws.z));
    GnChoice choice;
    if (a.x >= a.y && a.x >= a.z) {
        choice.first = d_ws.x >= 0.0f ? 0 : 1;
    } else if (a.y >= a.z) {
        choice.first = d_ws.y >= 0.0f ? 2 : 3;
    } else {
        choice.first = d_ws.z >= 0.0f ? 4 : 5;
    }
    choice.second = -1;
    choice.weight = 0.0f;
    return choice;
}

#endif
