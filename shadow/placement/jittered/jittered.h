// SPDX-License-Identifier: MIT
// Parameters of views that move by parts of a texel.
#ifndef GN_SHADOW_PLACEMENT_JITTERED_H
#define GN_SHADOW_PLACEMENT_JITTERED_H

#include "base/shared.h"

#define GN_JITTERED_FIT 0
#define GN_JITTERED_LISPSM 1
#define GN_JITTERED_TSM 2
#define GN_JITTERED_PSM 3
#define GN_JITTERED_CUBE 4

struct GnJitteredParams {
    int of GN_DEFAULT(GN_JITTERED_FIT);
    float extent GN_DEFAULT(1.0f);
};

#endif
