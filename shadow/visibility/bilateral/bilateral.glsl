// SPDX-License-Identifier: MIT
// Weights of the joint bilateral filter: how much a neighbour's visibility tells about a sample's.
// Based on: Petschnigg, Szeliski, Agrawala, Cohen, Hoppe, Toyama. Digital Photography with Flash and No-Flash Image
// Pairs. SIGGRAPH 2004. [PSA04]
// Departs from it: the guide is geometry, the distance from the sample's plane and the angle between normals.
#ifndef GN_SHADOW_VISIBILITY_BILATERAL_GLSL
#define GN_SHADOW_VISIBILITY_BILATERAL_GLSL

#include "shadow/visibility/bilateral/bilateral.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Gaussian of the distance in pixels, sigma half the radius.
GN_FN float gn_bilateral_spatial(int distance, int radius) {
    float x = 2.0f * float(distance) / float(max(radius, 1));
    return exp(-0.5f * x * x);
}

// Geometry: 1 in the sample's plane with its normal. `pixel_ws` is the width of a pixel at the sample, metres: distances
// from the plane are told apart at the scale at which the view sees them.
GN_FN float gn_bilateral_range(vec3 p_ws, vec3 n_ws, float pixel_ws, vec3 q_ws, vec3 q_n_ws, GnBilateralParams params) {
    float off_plane = abs(dot(n_ws, q_ws - p_ws)) / (params.plane * pixel_ws);
    float facing = max(dot(n_ws, q_n_ws), 0.0f);
    return exp(-0.5f * off_plane * off_plane) * pow(facing, params.normal);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
