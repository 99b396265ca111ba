// SPDX-License-Identifier: MIT
// One warped view serves every receiver, or six around a light that the receivers surround.
// Based on: Wimmer, Scherzer, Purgathofer. Light Space Perspective Shadow Maps. EGSR 2004. [WSP04]
#ifndef GN_SHADOW_PLACEMENT_LISPSM_GLSL
#define GN_SHADOW_PLACEMENT_LISPSM_GLSL

#include "shadow/placement/faces.glsl"

GN_FN GnChoice gn_lispsm_choose(GnReceiver receiver, GnFacesData data) {
    return gn_only(data.eye_ws.w > 0.5f ? gn_face_of(receiver.p_ws - vec3(data.eye_ws)) : 0);
}

#endif
