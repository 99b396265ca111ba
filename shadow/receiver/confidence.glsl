// SPDX-License-Identifier: MIT
// How well the texel that a receiver falls into speaks for it, and how far around it what a lookup finds reaches. Compiles as GLSL
// and as C++.
// Based on: Scherzer, Jeschke, Wimmer. Pixel-Correct Shadow Maps with Temporal Reprojection and Shadow Test Confidence. EGSR
// 2007. [SJW07]
#ifndef GN_SHADOW_CONFIDENCE_GLSL
#define GN_SHADOW_CONFIDENCE_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// 1 - 2 max(|x - x_c|, |y - y_c|), texels from the texel's centre: only there the map was sampled. At least a thousandth, since 0
// is said of samples that no view holds. [EASW09] 3.2.6
GN_FN float gn_confidence(GnProjected projected) {
    vec2 d = abs(fract(projected.uv_ts / projected.texel_ts) - 0.5f);
    return max(1.0f - 2.0f * max(d.x, d.y), 1.0e-3f);
}

// Metres across the rays around a receiver within which casters change its V: its kernel's, two texels to the centre of its own
// and of a caster's, and what the bias moves it aside.
GN_FN float gn_kernel_reach(GnProjected projected, GnBias bias) {
    float texels = bias.reach + 2.0f + abs(bias.normal) + abs(bias.view);
    return texels * projected.texel_ws + bias.reach_world + abs(bias.normal_world) + abs(bias.view_world);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
