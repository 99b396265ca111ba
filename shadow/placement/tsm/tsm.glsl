// SPDX-License-Identifier: MIT
// One warped view serves every receiver, or six around a light that the receivers surround.
// Based on: Martin, Tan. Anti-aliasing and Continuity with Trapezoidal Shadow Maps. EGSR 2004. [MT04]
#ifndef GN_SHADOW_PLACEMENT_TSM_GLSL
#define GN_SHADOW_PLACEMENT_TSM_GLSL

#include "shadow/placement/faces.glsl"

// data.values[0]: the light's position; w = 1 when the views are a cube's.
GN_FN GnChoice gn_tsm_choose(GnReceiver receiver, GnPlacementData data) {
    return gn_only(data.values[0].w > 0.5f ? gn_face_of(receiver.p_ws - vec3(data.values[0])) : 0);
}

#endif
