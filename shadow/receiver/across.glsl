// SPDX-License-Identifier: MIT
// Two axes across a direction.
// Based on: Duff et al. Building an Orthonormal Basis, Revisited. JCGT 2017. [DBC+17]
//
// It compiles as GLSL and as C++.
#ifndef GN_SHADOW_RECEIVER_ACROSS_GLSL
#define GN_SHADOW_RECEIVER_ACROSS_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Two unit vectors across a unit vector; x cross y = n.
GN_FN void gn_across(vec3 n, GN_OUT(vec3) x, GN_OUT(vec3) y) {
    float side = n.z >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (side + n.z);
    float b = n.x * n.y * a;
    x = vec3(1.0f + side * n.x * n.x * a, side * b, -side * n.x);
    y = vec3(b, side + n.y * n.y * a, -n.y);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
