// SPDX-License-Identifier: MIT
// Parameters of the split of a light.
#ifndef GN_SHADOW_LIGHT_SPLIT_H
#define GN_SHADOW_LIGHT_SPLIT_H

#include "base/shared.h"
#include "shadow/receiver/fusion.h"

struct GnSplitParams {
    int side GN_DEFAULT(2);
    int round GN_DEFAULT(0);  ///< true or false: discs, spheres and suns have pieces too
    int fusion GN_DEFAULT(GN_FUSION_SUM);
};

#endif
