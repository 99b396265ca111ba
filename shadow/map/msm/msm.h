// SPDX-License-Identifier: MIT
// Parameters of moment shadow maps.
#ifndef GN_SHADOW_MAP_MSM_H
#define GN_SHADOW_MAP_MSM_H

#include "shadow/map/prefilter_params.h"

#define GN_MSM_UNORM16 0
#define GN_MSM_FLOAT32 1
#define GN_MSM_HAMBURGER 0
#define GN_MSM_HAUSDORFF 1

struct GnMsmParams {
    int problem GN_DEFAULT(GN_MSM_HAMBURGER);
    int format GN_DEFAULT(GN_MSM_UNORM16);
    float moment_bias GN_DEFAULT(6.0e-5f);
    int samples GN_DEFAULT(1);
    GnPrefilterParams prefilter;
    float ramp GN_DEFAULT(0.1f);
    float depth_bias GN_DEFAULT(0.0f);
    float bleeding GN_DEFAULT(0.05f);
};

#endif
