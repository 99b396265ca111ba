// SPDX-License-Identifier: MIT
// Where the frame before saw what this one sees. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_REPROJECTION_GLSL
#define GN_SHADOW_REPROJECTION_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The place of a point (ws) in the picture before: x and y in [0,1] from its upper left corner where it shows the place, z =
// 1; behind the camera z = 0. before_from_now: ws, of the object that the point lies on; before_cs_from_ws: clip space, y
// downwards.
GN_FN vec3 gn_reproject(mat4 before_cs_from_ws, mat4 before_from_now, vec3 p_ws) {
    vec4 p_cs = before_cs_from_ws * (before_from_now * vec4(p_ws, 1.0f));
    if (p_cs.w <= 0.0f) {
        return vec3(0.0f);
    }
    return vec3(0.5f * p_cs.x / p_cs.w + 0.5f, 0.5f * p_cs.y / p_cs.w + 0.5f, 1.0f);
}

#ifdef __cplusplus
}
#endif
#endif
