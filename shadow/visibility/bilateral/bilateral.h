// SPDX-License-Identifier: MIT
// Parameters of the joint bilateral filter of visibility.
#ifndef GN_SHADOW_VISIBILITY_BILATERAL_H
#define GN_SHADOW_VISIBILITY_BILATERAL_H

#include "base/shared.h"

struct GnBilateralParams {
    int radius GN_DEFAULT(2);
    float plane GN_DEFAULT(2.0f);
    float normal GN_DEFAULT(32.0f);
};

#endif
