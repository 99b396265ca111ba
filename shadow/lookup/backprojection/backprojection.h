// SPDX-License-Identifier: MIT
// Parameters of backprojection.
#ifndef GN_SHADOW_LOOKUP_BACKPROJECTION_H
#define GN_SHADOW_LOOKUP_BACKPROJECTION_H

#include "base/shared.h"

#define GN_BACK_MICROPATCH 0
#define GN_BACK_MICROQUAD 1
#define GN_BACK_MICROTRI 2
#define GN_BACK_MICRORECT 3
#define GN_BACK_CONTOUR 4

#define GN_BACK_AREA 0
#define GN_BACK_BITMASK 1

#define GN_BACK_NONE 0
#define GN_BACK_HSM 1
#define GN_BACK_MSSM 2
#define GN_BACK_YSM 3

#define GN_BACK_UNION 0
#define GN_BACK_FARTHEST 1
#define GN_BACK_SUM 2
#define GN_BACK_MAX 3
#define GN_BACK_MEAN 4
#define GN_BACK_PRODUCT 5

struct GnBackprojectionParams {
    int occluder GN_DEFAULT(GN_BACK_MICROQUAD);
    int combine GN_DEFAULT(GN_BACK_BITMASK);
    int pyramid GN_DEFAULT(GN_BACK_YSM);
    int refine GN_DEFAULT(3);
    int early_out GN_DEFAULT(1);
    int budget GN_DEFAULT(144);
    int blend GN_DEFAULT(1);
    int corners GN_DEFAULT(1);
    float level_bias GN_DEFAULT(1.0f);
    float least GN_DEFAULT(0.0f);
    int gaps GN_DEFAULT(1);
    float gap_limit GN_DEFAULT(0.0f);
    int layers GN_DEFAULT(1);
    int fusion GN_DEFAULT(GN_BACK_UNION);
    int sparse GN_DEFAULT(0);
    float sparse_samples GN_DEFAULT(8.0f);
    int packet GN_DEFAULT(1);
};

#endif
