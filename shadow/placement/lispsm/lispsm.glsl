// SPDX-License-Identifier: MIT
// One warped view serves every receiver, or six around a light that the receivers surround.
// Based on: Wimmer, Scherzer, Purgathofer. Light Space Perspective Shadow Maps. EGSR 2004. [WSP04]
#ifndef GN_SHADOW_PLACEMENT_LISPSM_GLSL
#define GN_SHADOW_PLACEMENT_LISPSM_GLSL

#include "shadow/placement/faces.glsl"

GN_FN GnChoice gn_lispsm_choose(GnReceiver receiver, GnFacesData data) {
    return gn_face_choice(receiver, data);
}

#endif
