// SPDX-License-Identifier: MIT
// Parameters of exponential variance shadow maps.
#ifndef GN_SHADOW_MAP_EVSM_H
#define GN_SHADOW_MAP_EVSM_H

#include "shadow/map/prefilter_params.h"

#define GN_EVSM_TWO 0
#define GN_EVSM_FOUR 1
#define GN_EVSM_FLOAT16 0
#define GN_EVSM_FLOAT32 1

struct GnEvsmParams {
    int components GN_DEFAULT(GN_EVSM_FOUR);
    int format GN_DEFAULT(GN_EVSM_FLOAT32);
    float exponent GN_DEFAULT(0.0f);
    float exponent_negative GN_DEFAULT(0.0f);
    int samples GN_DEFAULT(1);
    GnPrefilterParams prefilter;
    int slope_moment GN_DEFAULT(1);
    float min_deviation GN_DEFAULT(1.0f);
    float bleeding GN_DEFAULT(0.2f);
};

#endif
