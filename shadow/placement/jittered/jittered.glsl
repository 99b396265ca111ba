// SPDX-License-Identifier: MIT
// The views of another placement, moved by a part of a texel in every frame.
// Based on: Scherzer, Jeschke, Wimmer. Pixel-Correct Shadow Maps with Temporal Reprojection and Shadow Test Confidence. EGSR
// 2007. [SJW07]
// Departs from it: places follow each other by an additive recurrence, which fills a texel more evenly than random ones.
#ifndef GN_SHADOW_PLACEMENT_JITTERED_GLSL
#define GN_SHADOW_PLACEMENT_JITTERED_GLSL

#include "shadow/placement/faces.glsl"
#include "shadow/placement/jittered/jittered.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Where in its texel the map lies in a frame, from the middle, in texels: none in the first. Steps by the plastic number.
GN_FN vec2 gn_jitter(uint frame) {
    uvec2 step = uvec2(3242174889u, 2447445414u) * frame;
    return vec2(step + 0x80000000u) / 4294967296.0f - 0.5f;
}

GN_FN GnChoice gn_jittered_choose(GnReceiver receiver, GnFacesData data) {
    return gn_face_choice(receiver, data);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
