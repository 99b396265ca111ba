// SPDX-License-Identifier: MIT
// One view serves every receiver.
// Based on: Williams. Casting Curved Shadows on Curved Surfaces. SIGGRAPH 1978. [Wil78]
#ifndef GN_SHADOW_PLACEMENT_SINGLE_GLSL
#define GN_SHADOW_PLACEMENT_SINGLE_GLSL

#include "shadow/placement/faces.glsl"

GN_FN GnChoice gn_single_choose(GnReceiver receiver, GnPlacementData data) { return gn_only(0); }

#endif
