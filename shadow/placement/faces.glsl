// SPDX-License-Identifier: MIT
// Which of six faces around a point another point lies behind: +x -x +y -y +z -z.
#ifndef GN_SHADOW_PLACEMENT_FACES_GLSL
#define GN_SHADOW_PLACEMENT_FACES_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What the choice of a face is given.
struct GnFacesData {
    vec4 eye_ws GN_DEFAULT(vec4(0.0f));  // the light's place; w = 1 where the views are the six faces around it
};

GN_FN int gn_face_of(vec3 d_ws) {
    vec3 a = vec3(abs(d_ws.x), abs(d_ws.y), abs(d_ws.z));
    if (a.x >= a.y && a.x >= a.z) {
        return d_ws.x >= 0.0f ? 0 : 1;
    }
    if (a.y >= a.z) {
        return d_ws.y >= 0.0f ? 2 : 3;
    }
    return d_ws.z >= 0.0f ? 4 : 5;
}

GN_FN GnChoice gn_only(int view) {
    GnChoice choice;
    choice.first = view;
    choice.second = -1;
    choice.weight = 0.0f;
    return choice;
}

// The one view there is, or the face around the light that the receiver lies behind.
GN_FN GnChoice gn_face_choice(GnReceiver receiver, GnFacesData data) {
    return gn_only(data.eye_ws.w > 0.5f ? gn_face_of(receiver.p_ws - vec3(data.eye_ws)) : 0);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
