// SPDX-License-Identifier: MIT
// Parameters of variance shadow maps.
#ifndef GN_SHADOW_MAP_VSM_H
#define GN_SHADOW_MAP_VSM_H

#include "shadow/map/prefilter_params.h"

#define GN_VSM_LINEAR 0
#define GN_VSM_SMOOTHSTEP 1

struct GnVsmParams {
    int samples GN_DEFAULT(1);
    GnPrefilterParams prefilter;
    int slope_moment GN_DEFAULT(1);
    float min_deviation GN_DEFAULT(1.0f);
    float max_deviation GN_DEFAULT(0.5f);
    float bleeding GN_DEFAULT(0.2f);
    int reduction GN_DEFAULT(GN_VSM_LINEAR);
    int squares GN_DEFAULT(0);
};

#endif
