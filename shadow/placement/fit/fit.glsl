// SPDX-License-Identifier: MIT
// One fitted view serves every receiver, or six around a light that the receivers surround.
// Based on: Brabec, Annen, Seidel. Practical Shadow Mapping. Journal of Graphics Tools 2002. [BAS02b]
#ifndef GN_SHADOW_PLACEMENT_FIT_GLSL
#define GN_SHADOW_PLACEMENT_FIT_GLSL

#include "shadow/placement/faces.glsl"

GN_FN GnChoice gn_fit_choose(GnReceiver receiver, GnFacesData data) {
    return gn_face_choice(receiver, data);
}

#endif
