// SPDX-License-Identifier: MIT
// Parameters of forward shadow mapping.
#ifndef GN_SHADOW_DIRECT_FORWARD_H
#define GN_SHADOW_DIRECT_FORWARD_H

#include "base/shared.h"

struct GnForwardParams {
    int radius GN_DEFAULT(1);
    float tolerance GN_DEFAULT(1.0f);
    int max_pixels GN_DEFAULT(64);
};

#endif
