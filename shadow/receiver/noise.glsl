// SPDX-License-Identifier: MIT
// Noise over the screen, and the points that it turns. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_NOISE_GLSL
#define GN_SHADOW_NOISE_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Interleaved gradient noise in [0,1) of a pixel. [Jim14]
GN_FN float gn_gradient_noise(vec2 p_ss) {
    float inner = 0.06711056f * p_ss.x + 0.00583715f * p_ss.y;
    inner = 52.9829189f * (inner - floor(inner));
    return inner - floor(inner);
}

// The same of a surface: it stays where it is as the camera moves, but where a pixel's size there passes from one power of two to
// the next. Of the cell in which a point lies of a grid over the two axes along which the surface mostly runs.
GN_FN float gn_surface_noise(vec3 p_ws, vec3 n_ws, float pixel_ws) {
    vec3 a = abs(n_ws);
    vec2 p = a.x > max(a.y, a.z) ? vec2(p_ws.y, p_ws.z) : a.y > a.z ? vec2(p_ws.x, p_ws.z) : vec2(p_ws.x, p_ws.y);
    vec2 cell = floor(p * exp2(-floor(log2(max(pixel_ws, 1.0e-30f)) + 0.5f)));
    return gn_gradient_noise(cell - 4096.0f * floor(cell / 4096.0f) + 0.5f);
}

// Point i of n on a disc: the golden-angle spiral. [Vog79]
GN_FN vec2 gn_vogel(int i, int n, float phase) {
    float r = sqrt((float(i) + 0.5f) / float(n));
    float angle = float(i) * 2.39996323f + phase;
    return r * vec2(cos(angle), sin(angle));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
