// SPDX-License-Identifier: MIT
// One fitted view serves every receiver, or six around a light that the receivers surround.
// Based on: Brabec, Annen, Seidel. Practical Shadow Mapping. Journal of Graphics Tools 2002. [BAS02b]
#ifndef GN_SHADOW_PLACEMENT_FIT_GLSL
#define GN_SHADOW_PLACEMENT_FIT_GLSL

#include "shadow/placement/faces.glsl"

GN_FN GnChoice gn_fit_choose(GnReceiver receiver, GnFacesData data) {
    return gn_only(data.eye_ws.w > 0.5f ? gn_face_of(receiver.p_ws - vec3(data.eye_ws)) : 0);
}

#endif
