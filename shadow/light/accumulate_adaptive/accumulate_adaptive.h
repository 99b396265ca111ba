// SPDX-License-Identifier: MIT
// Parameters of adaptively accumulated shadows.
#ifndef GN_SHADOW_LIGHT_ACCUMULATE_ADAPTIVE_H
#define GN_SHADOW_LIGHT_ACCUMULATE_ADAPTIVE_H

#include "base/shared.h"

struct GnAccumulateAdaptiveParams {
    int levels GN_DEFAULT(4);            ///< the finest cells are 4^levels
    int start GN_DEFAULT(1);             ///< levels of a sequence's first frame
    float threshold GN_DEFAULT(0.005f);  ///< share of the picture's pixels
};

#endif
