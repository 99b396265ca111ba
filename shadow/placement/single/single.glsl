// SPDX-License-Identifier: MIT
// One view serves every receiver.
// Based on: Williams. Casting Curved Shadows on Curved Surfaces. SIGGRAPH 1978. [Wil78]
#ifndef GN_SHADOW_PLACEMENT_SINGLE_GLSL
#define GN_SHADOW_PLACEMENT_SINGLE_GLSL

#include "shadow/receiver.glsl"

GN_FN GnChoice gn_single_choose(GnReceiver receiver, GnPlacementData data) {
    GnChoice choice;
    choice.first = 0;
    choice.second = -1;
    choice.weight = 0.0f;
    return choice;
}

#endif
