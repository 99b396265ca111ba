// SPDX-License-Identifier: MIT
// Parameters of summed-area variance shadow maps.
#ifndef GN_SHADOW_MAP_SAT_VSM_H
#define GN_SHADOW_MAP_SAT_VSM_H

#include "base/shared.h"
#include "shadow/map/sums_params.h"
#include "shadow/map/vsm/vsm.h"

struct GnSatVsmParams {
    int table GN_DEFAULT(GN_SAT_UINT32);
    int scan GN_DEFAULT(GN_SAT_SCAN_AUTO);
    int max_box GN_DEFAULT(64);
    float radius GN_DEFAULT(2.0f);
    int samples GN_DEFAULT(1);
    int slope_moment GN_DEFAULT(1);
    float min_deviation GN_DEFAULT(2.0f);
    float max_deviation GN_DEFAULT(0.5f);
    float bleeding GN_DEFAULT(0.2f);
    int reduction GN_DEFAULT(GN_VSM_LINEAR);
};

#endif
