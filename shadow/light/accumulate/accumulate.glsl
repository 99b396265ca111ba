// SPDX-License-Identifier: MIT
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
#ifndef GN_SHADOW_LIGHT_ACCUMULATE_GLSL
#define GN_SHADOW_LIGHT_ACCUMULATE_GLSL

#include "shadow/light/accumulate/accumulate.h"
#include "shadow/scene/light_samples.h"

#ifndef __cplusplus
// [EASW09] eq. 1.6: V is the mean of the points' V, each weighed as V is uniform over the light.
float gn_accumulate_weight(GnLight light, GnLight one, vec3 p_ws, ivec2 pixel, int index, int count,
                           GnAccumulateParams params) {
    return gn_point_taken(index, count, pixel, params.share) ? gn_point_weight(light, one, p_ws) : 0.0;
}
#endif

#endif
