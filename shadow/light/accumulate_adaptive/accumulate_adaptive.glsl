// SPDX-License-Identifier: MIT
// Based on: Schwaerzler, Mattausch, Scherzer, Wimmer. Fast Accurate Soft Shadows with Adaptive Light Source Sampling. VMV 2012.
// [SMSW12]
#ifndef GN_SHADOW_LIGHT_ACCUMULATE_ADAPTIVE_GLSL
#define GN_SHADOW_LIGHT_ACCUMULATE_ADAPTIVE_GLSL

#include "shadow/light/accumulate_adaptive/accumulate_adaptive.h"
#include "shadow/scene/light_samples.h"

#ifndef __cplusplus
// A point weighs the share of the light that its cell is, which it carries as its intensity.
float gn_accumulate_adaptive_weight(GnLight light, GnLight one, vec3 p_ws, ivec2 pixel, int index, int count,
                                    GnAccumulateAdaptiveParams params) {
    return one.intensity * gn_point_weight(light, one, p_ws);
}
#endif

#endif
