// SPDX-License-Identifier: MIT
// A box filter of any width along a row of texels; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_PLANAR_SOFT_GLSL
#define GN_SHADOW_DIRECT_PLANAR_SOFT_GLSL

#include "shadow/direct/planar_soft/planar_soft.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What the texel `offset` texels away weighs in a box `width` texels wide around a texel's centre: the share of the box that
// it covers.
GN_FN float gn_planar_soft_weight(int offset, float width) {
    float half_width = 0.5f * max(width, 1.0f);
    float low = max(float(offset) - 0.5f, -half_width);
    float high = min(float(offset) + 0.5f, half_width);
    return max(high - low, 0.0f) / (2.0f * half_width);
}

// Texels on either side that weigh something.
GN_FN int gn_planar_soft_reach(float width) {
    return int(ceil(0.5f * max(width, 1.0f) - 0.5f));
}

// How wide the penumbra of a straight edge is on the plane: of a light `size` metres wide, `light_height` above the plane, behind
// a caster at `caster_height`. [AHH18] section 7.1.2, by similar triangles.
GN_FN float gn_planar_soft_width(float size, float light_height, float caster_height) {
    return size * caster_height / (light_height - caster_height);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
