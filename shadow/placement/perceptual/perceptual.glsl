// SPDX-License-Identifier: MIT
// As many texels as the filter hides: the law of the resolution, and the choice of `fit`, whose views these are.
// Based on: Kreuzer. Using Perception-Based Filtering to Hide Shadow Artifacts. TU Wien 2017. [Kre17], chapter 5.
#ifndef GN_SHADOW_PLACEMENT_PERCEPTUAL_GLSL
#define GN_SHADOW_PLACEMENT_PERCEPTUAL_GLSL

#include "shadow/placement/faces.glsl"
#include "shadow/placement/perceptual/perceptual.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Texels along an axis of a map that covers `extent` of the light's plane before it is widened, for a filter of `radius` on
// that plane: s_res = c L / r (eq. 5.6; of fitted maps L_WS / s_xy is the extent itself), and to each side `guard` texels
// more, so that a texel is r / c (eq. 5.4). A filter without a radius asks for all there are.
GN_FN float gn_perceptual_texels(float c, float extent, float radius, float guard, float most) {
    return radius * most > c * extent ? c * extent / radius + 2.0f * guard : most;
}

// Whole blocks of 8 texels: three mips then serve the map's rectangle to its borders.
GN_FN int gn_perceptual_blocks(float texels) { return 8 * int(ceil(texels / 8.0f)); }

// A resolution that follows what is wanted by at most a share of itself a frame, and by a block where that is less. 6.2
GN_FN int gn_perceptual_follow(int wanted, int before, float change) {
    if (before <= 0) {
        return wanted;
    }
    int most = max(before + 8, 8 * int(floor(float(before) * (1.0f + change) / 8.0f)));
    int least = min(before - 8, gn_perceptual_blocks(float(before) / (1.0f + change)));
    return clamp(wanted, least, most);
}

GN_FN GnChoice gn_perceptual_choose(GnReceiver receiver, GnFacesData data) {
    return gn_face_choice(receiver, data);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
