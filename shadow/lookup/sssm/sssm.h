// SPDX-License-Identifier: MIT
// Parameters of separable soft shadows.
#ifndef GN_SHADOW_LOOKUP_SSSM_H
#define GN_SHADOW_LOOKUP_SSSM_H

#include "base/shared.h"

struct GnSssmParams {
    int separable GN_DEFAULT(1);
    int side GN_DEFAULT(9);
    int jitter GN_DEFAULT(1);
    float least GN_DEFAULT(1.5f);
    float plane GN_DEFAULT(4.0f);
    float widths GN_DEFAULT(2.0f);
    int early_out GN_DEFAULT(1);
};

#endif
