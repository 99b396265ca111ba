// SPDX-License-Identifier: MIT
// Based on: Johnson, Hunt, Hux, Mark, Burns, Junkins. Soft Irregular Shadow Mapping. I3D 2009.
// [JHHM09]
#ifndef GN_SHADOW_DIRECT_SOFT_IRREGULAR_H
#define GN_SHADOW_DIRECT_SOFT_IRREGULAR_H

#include "base/shared.h"

#define GN_SOFT_IRREGULAR_BOTH 0
#define GN_SOFT_IRREGULAR_OUTER 1

struct GnSoftIrregularParams {
    int penumbra GN_DEFAULT(GN_SOFT_IRREGULAR_BOTH);  ///< outer: what the light's centre does not see stays dark
    int closed GN_DEFAULT(1);                         ///< 1: a solid casts with one side of its surface only
};

#endif
