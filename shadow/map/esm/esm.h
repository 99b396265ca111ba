// SPDX-License-Identifier: MIT
// Parameters of exponential shadow maps.
#ifndef GN_SHADOW_MAP_ESM_H
#define GN_SHADOW_MAP_ESM_H

#include "shadow/map/prefilter_params.h"

#define GN_ESM_PRODUCT 0
#define GN_ESM_MAXIMUM 1

struct GnEsmParams {
    float exponent GN_DEFAULT(80.0f);
    int fallback GN_DEFAULT(1);
    int classifier GN_DEFAULT(GN_ESM_PRODUCT);
    float epsilon GN_DEFAULT(0.02f);
    int samples GN_DEFAULT(1);
    GnPrefilterParams prefilter;
};

#endif
