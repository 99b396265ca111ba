// SPDX-License-Identifier: MIT
// Parameters of layered variance shadow maps.
#ifndef GN_SHADOW_MAP_LVSM_H
#define GN_SHADOW_MAP_LVSM_H

#include "shadow/map/prefilter_params.h"

#define GN_LVSM_MAX_LAYERS 16
#define GN_LVSM_BINS 1024  // of the histogram that places relaxed splits

#define GN_LVSM_UNIFORM 0
#define GN_LVSM_LLOYD 1

#define GN_LVSM_UNORM16 0
#define GN_LVSM_FLOAT32 1
#define GN_LVSM_UNORM8 2

struct GnLvsmParams {
    int layers GN_DEFAULT(4);
    int splits GN_DEFAULT(GN_LVSM_LLOYD);
    int iterations GN_DEFAULT(8);
    float weight_least GN_DEFAULT(0.0f);
    float weight_most GN_DEFAULT(1.0f);
    float overlap GN_DEFAULT(0.05f);
    float transition GN_DEFAULT(1.0f);
    int format GN_DEFAULT(GN_LVSM_UNORM16);
    int samples GN_DEFAULT(1);
    GnPrefilterParams prefilter;
    int slope_moment GN_DEFAULT(1);
    float min_deviation GN_DEFAULT(1.0f);
    float bleeding GN_DEFAULT(0.2f);
};

#endif
