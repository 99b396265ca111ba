// SPDX-License-Identifier: MIT
// One warped view serves every receiver, or six around a light that the receivers surround.
// Based on: Martin, Tan. Anti-aliasing and Continuity with Trapezoidal Shadow Maps. EGSR 2004. [MT04]
#ifndef GN_SHADOW_PLACEMENT_TSM_GLSL
#define GN_SHADOW_PLACEMENT_TSM_GLSL

#include "shadow/placement/faces.glsl"

GN_FN GnChoice gn_tsm_choose(GnReceiver receiver, GnFacesData data) {
    return gn_face_choice(receiver, data);
}

#endif
