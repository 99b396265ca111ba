// SPDX-License-Identifier: MIT
#ifndef GN_SHADOW_LIGHT_ACCUMULATE_H
#define GN_SHADOW_LIGHT_ACCUMULATE_H

#include "base/shared.h"

struct GnAccumulateParams {
    int lights GN_DEFAULT(64);  ///< points of the light
    int share GN_DEFAULT(1);    ///< side of the square of pixels that share the points out among them
};

#endif
