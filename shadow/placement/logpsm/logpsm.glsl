// SPDX-License-Identifier: MIT
// One warped view serves every receiver, or six around a light that the receivers surround.
// Based on: Lloyd. Logarithmic Perspective Shadow Maps. University of North Carolina at Chapel Hill 2007. [Llo07]
#ifndef GN_SHADOW_PLACEMENT_LOGPSM_GLSL
#define GN_SHADOW_PLACEMENT_LOGPSM_GLSL

#include "shadow/placement/faces.glsl"

GN_FN GnChoice gn_logpsm_choose(GnReceiver receiver, GnFacesData data) {
    return gn_face_choice(receiver, data);
}

#endif
