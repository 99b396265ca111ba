// SPDX-License-Identifier: MIT
// Based on: Yang, Feng, Guennebaud, Liu. Packet-based Hierarchal Soft Shadow Mapping. EGSR 2009. [YFG+09]
#ifndef GN_SHADOW_LIGHT_SPLIT_GLSL
#define GN_SHADOW_LIGHT_SPLIT_GLSL

#include "shadow/light/split/split.h"
#include "shadow/scene/light.h"

#ifndef __cplusplus
// How shadow/light/weighted.cpp unites what pieces hide.
#define GN_LIGHT_FUSION(params) ((params).fusion)

// Pieces are of one size, and V is uniform over them.
float gn_split_weight(GnLight light, GnLight one, vec3 p_ws, ivec2 pixel, int index, int count, GnSplitParams params) {
    return 1.0;
}
#endif

#endif
