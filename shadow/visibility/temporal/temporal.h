// SPDX-License-Identifier: MIT
// Parameters of shadows that are gathered over frames.
#ifndef GN_SHADOW_VISIBILITY_TEMPORAL_H
#define GN_SHADOW_VISIBILITY_TEMPORAL_H

#include "base/shared.h"

struct GnTemporalParams {
    float exponent GN_DEFAULT(15.0f);
    float memory GN_DEFAULT(1.0f);
};

#endif
