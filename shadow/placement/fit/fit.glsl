// SPDX-License-Identifier: MIT
// One fitted view serves every receiver, or six around a light that the receivers surround.
// Based on: Brabec, Annen, Seidel. Practical Shadow Mapping. Journal of Graphics Tools 2002. [BAS02b]
#ifndef GN_SHADOW_PLACEMENT_FIT_GLSL
#define GN_SHADOW_PLACEMENT_FIT_GLSL

#include "shadow/placement/faces.glsl"

// data.values[0]: the light's position; w = 1 when the views are a cube's.
GN_FN GnChoice gn_fit_choose(GnReceiver receiver, GnPlacementData data) {
    return gn_only(data.values[0].w > 0.5f ? gn_face_of(receiver.p_ws - vec3(data.values[0])) : 0);
}

#endif
