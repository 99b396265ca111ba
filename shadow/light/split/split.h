// SPDX-License-Identifier: MIT
// Parameters of the split of a rectangle.
#ifndef GN_SHADOW_LIGHT_SPLIT_H
#define GN_SHADOW_LIGHT_SPLIT_H

#include "base/shared.h"

struct GnSplitParams {
    int side GN_DEFAULT(2);
};

#endif
