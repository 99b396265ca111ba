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
