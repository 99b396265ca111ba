// SPDX-License-Identifier: MIT
// Parameters of penumbra deep shadow maps.
#ifndef GN_SHADOW_MAP_PENUMBRA_DEEP_H
#define GN_SHADOW_MAP_PENUMBRA_DEEP_H

#include "base/shared.h"

struct GnPenumbraDeepParams {
    int lights GN_DEFAULT(32);        ///< points of the light, a map each
    int nodes GN_DEFAULT(16);         ///< of a texel's function
    float epsilon GN_DEFAULT(0.05f);  ///< what a function's V may err by
};

#endif
