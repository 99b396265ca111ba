// SPDX-License-Identifier: MIT
// Samples that are looked up, and those between them that are interpolated, by how wide the penumbra is on the picture. Compiles as
// GLSL and as C++.
// Based on: Guennebaud, Barthe, Paulin. High-Quality Adaptive Soft Shadow Mapping. Computer Graphics Forum 2007. [GBP07]
#ifndef GN_SHADOW_BACKPROJECTION_SPARSE_GLSL
#define GN_SHADOW_BACKPROJECTION_SPARSE_GLSL

#include "shadow/lookup/backprojection/backprojection.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// How often the distance of a pixel may be doubled: a penumbra that is so many pixels wide keeps its samples.
GN_FN int gn_back_apart(float pixels, GnBackprojectionParams params) {
    return clamp(int(floor(log2(max(pixels / params.sparse_samples, 1.0f)))), 0, params.sparse);
}

// Both in one number of [0,1], exactly: V where it is decided, else the doublings. A mixture of two is neither.
GN_FN float gn_back_told(float visibility, int apart) {
    return visibility == 1.0f ? 1.0f : visibility == 0.0f ? 0.75f : float(apart) / 8.0f;
}
GN_FN float gn_back_told_visibility(float told) { return told == 1.0f ? 1.0f : told == 0.75f ? 0.0f : -1.0f; }
GN_FN int gn_back_told_apart(float told) {
    float eighths = 8.0f * told;
    return eighths == floor(eighths) && eighths < 5.0f ? int(eighths) : 0;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
