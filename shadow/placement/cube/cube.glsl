// SPDX-License-Identifier: MIT
// Six views around the light; the receiver's is the face it lies behind.
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
#ifndef GN_SHADOW_PLACEMENT_CUBE_GLSL
#define GN_SHADOW_PLACEMENT_CUBE_GLSL

#include "shadow/placement/faces.glsl"

// Each face's view is wider than 90 degrees, so that a kernel at its border still reads its own face: no seam.
GN_FN GnChoice gn_cube_choose(GnReceiver receiver, GnFacesData data) {
    return gn_only(gn_face_of(receiver.p_ws - vec3(data.eye_ws)));
}

#endif
