// SPDX-License-Identifier: MIT
// Parameters of convolution shadow maps.
#ifndef GN_SHADOW_MAP_CONVOLUTION_H
#define GN_SHADOW_MAP_CONVOLUTION_H

#include "shadow/map/prefilter_params.h"

struct GnConvolutionParams {
    int terms GN_DEFAULT(16);
    float attenuation GN_DEFAULT(0.5f);
    float offset GN_DEFAULT(0.0f);
    float scale GN_DEFAULT(2.0f);
    float span GN_DEFAULT(0.9f);
    GnPrefilterParams prefilter;
};

#endif
