// SPDX-License-Identifier: MIT
// Which face of the camera's frustum a receiver's ray of light goes through. Compiles as GLSL and as C++.
// Based on: Lloyd, Tuft, Yoon, Manocha. Warping and Partitioning for Low Error Shadow Maps. EGSR 2006. [LTYM06]
#ifndef GN_SHADOW_PLACEMENT_FRUSTUM_FACES_GLSL
#define GN_SHADOW_PLACEMENT_FRUSTUM_FACES_GLSL

#include "shadow/placement/faces.glsl"
#include "shadow/placement/faces/faces.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The face that the ray through a point of the frustum meets first, away from the light or towards it.
GN_FN int gn_frustum_face(vec3 p_ws, GnFrustumFaces data) {
    int face = 0;
    float least = dot(data.keys_ws[0], vec4(p_ws, 1.0f));
    for (int i = 1; i < GN_FRUSTUM_FACES; ++i) {
        float key = dot(data.keys_ws[i], vec4(p_ws, 1.0f));
        face = key < least ? i : face;
        least = min(key, least);
    }
    return face;
}

GN_FN GnChoice gn_faces_choose(GnReceiver receiver, GnFrustumFaces data) {
    return gn_only(data.eye_ws.w > 0.5f ? gn_face_of(receiver.p_ws - vec3(data.eye_ws))
                                        : gn_frustum_face(receiver.p_ws, data));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
