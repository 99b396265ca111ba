// SPDX-License-Identifier: MIT
// Based on: Johnson, Hunt, Hux, Mark, Burns, Junkins. Soft Irregular Shadow Mapping. I3D 2009. [JHHM09]
//
// What edges hide, summed in any order to the same bits; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_SOFT_IRREGULAR_GLSL
#define GN_SHADOW_DIRECT_SOFT_IRREGULAR_GLSL

#include "shadow/direct/soft_irregular/soft_irregular.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Steps of a sum of shares of the light: an edge hides at most half of it, so that 4095 edges fit 32 bits.
const float gn_soft_irregular_one = 1048576.0f;

// What an edge hides of the light beyond what its centre says (or shows, below 0), in such steps.
GN_FN int gn_soft_irregular_steps(float hidden, int penumbra) {
    float counted = penumbra == GN_SOFT_IRREGULAR_OUTER ? max(hidden, 0.0f) : hidden;
    return int(floor(counted * gn_soft_irregular_one + 0.5f));
}

// V of a sample whose centre of the light is hidden or not, from the sum.
GN_FN float gn_soft_irregular_light(bool hidden, int steps) {
    return clamp((hidden ? 0.0f : 1.0f) - float(steps) / gn_soft_irregular_one, 0.0f, 1.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
