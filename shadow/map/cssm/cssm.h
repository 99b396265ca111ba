// SPDX-License-Identifier: MIT
// Parameters of convolution soft shadow maps.
#ifndef GN_SHADOW_MAP_CSSM_H
#define GN_SHADOW_MAP_CSSM_H

#include "shadow/map/prefilter_params.h"

#define GN_CSSM_UNORM8 0
#define GN_CSSM_UNORM16 1

struct GnCssmParams {
    int terms GN_DEFAULT(16);
    int format GN_DEFAULT(GN_CSSM_UNORM8);
    float attenuation GN_DEFAULT(0.0f);
    float offset GN_DEFAULT(0.6f);
    float search_offset GN_DEFAULT(0.7f);
    float span GN_DEFAULT(0.9f);
    GnPrefilterParams prefilter;
};

#endif
