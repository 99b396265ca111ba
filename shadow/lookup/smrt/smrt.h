// SPDX-License-Identifier: MIT
// Parameters of soft shadows by rays through the map.
#ifndef GN_SHADOW_LOOKUP_SMRT_H
#define GN_SHADOW_LOOKUP_SMRT_H

#include "base/shared.h"

#define GN_SMRT_OPEN 0
#define GN_SMRT_EXTENDED 1

#define GN_SMRT_OF_TEXEL 0
#define GN_SMRT_OF_PIXEL 1

struct GnSmrtParams {
    int rays GN_DEFAULT(16);
    int steps GN_DEFAULT(8);
    float least GN_DEFAULT(0.0f);
    int gaps GN_DEFAULT(GN_SMRT_EXTENDED);
    float steepest GN_DEFAULT(6.0f);
    int noise GN_DEFAULT(GN_SMRT_OF_TEXEL);
};

#endif
