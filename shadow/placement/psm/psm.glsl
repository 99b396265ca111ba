// SPDX-License-Identifier: MIT
// One warped view serves every receiver, or six around a light that the receivers surround.
// Based on: Stamminger, Drettakis. Perspective Shadow Maps. SIGGRAPH 2002. [SD02]
#ifndef GN_SHADOW_PLACEMENT_PSM_GLSL
#define GN_SHADOW_PLACEMENT_PSM_GLSL

#include "shadow/placement/faces.glsl"

GN_FN GnChoice gn_psm_choose(GnReceiver receiver, GnFacesData data) {
    return gn_face_choice(receiver, data);
}

#endif
