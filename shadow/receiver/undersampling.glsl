// SPDX-License-Identifier: MIT
// How coarse the texels of a map are on the screen. Compiles as GLSL and as C++.
//
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
// Departs from it: equations 3.1 and 3.2 are of one axis of the map, in the plane of the eye's ray and the light's. Here m is
// the larger singular value of the derivative of pixels over texels, which is that axis's m wherever an axis lies so.
#ifndef GN_SHADOW_UNDERSAMPLING_GLSL
#define GN_SHADOW_UNDERSAMPLING_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// m where the receiver is seen edge-on from the light or from the camera: one texel covers any number of pixels.
const float gn_edge_on = 1.0e30f;

// m of a receiver whose texel coordinates change by these numbers of texels from one pixel to the next, to the right and
// downwards: pixels that a texel covers in the direction where it is longest. Above 1 texels are seen as steps.
GN_FN float gn_undersampling_of(vec2 to_right, vec2 downwards) {
    float area = to_right.x * downwards.y - to_right.y * downwards.x;
    float squares = dot(to_right, to_right) + dot(downwards, downwards);
    float root = sqrt(max(squares * squares - 4.0f * area * area, 0.0f));
    // The larger singular value of an inverse is the larger one of the matrix over its determinant.
    float larger = sqrt(0.5f * (squares + root));
    return larger < gn_edge_on * abs(area) ? larger / abs(area) : gn_edge_on;
}

// The same on a map with these gradients of uv over the world (gn_uv_gradients, per metre) and as many texels along its
// unit of uv. With a resolution of 1 it is the resolution at which m is 1: what the receiver asks for.
GN_FN float gn_undersampling(GnReceiver receiver, vec3 du_ws, vec3 dv_ws, float resolution) {
    vec2 to_right = vec2(dot(du_ws, receiver.ddx_ws), dot(dv_ws, receiver.ddx_ws));
    vec2 downwards = vec2(dot(du_ws, receiver.ddy_ws), dot(dv_ws, receiver.ddy_ws));
    return gn_undersampling_of(to_right * resolution, downwards * resolution);
}

// The same of the view that a receiver is looked up in.
GN_FN float gn_undersampling_in(GnReceiver receiver, GnProjected projected) {
    return gn_undersampling(receiver, projected.du_ws, projected.dv_ws, 1.0f / projected.texel_ts);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
