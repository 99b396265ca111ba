// SPDX-License-Identifier: MIT
// Parameters of the one lookup of all prefiltered maps.
#ifndef GN_SHADOW_LOOKUP_FILTERED_H
#define GN_SHADOW_LOOKUP_FILTERED_H

#include "base/shared.h"

#define GN_FILTERED_PIXEL 0
#define GN_FILTERED_RADIUS 1
#define GN_FILTERED_WORLD 2

struct GnFilteredParams {
    int footprint GN_DEFAULT(GN_FILTERED_PIXEL);
    float radius GN_DEFAULT(1.5f);
    float radius_world GN_DEFAULT(0.0f);
    float sharpness GN_DEFAULT(1.0f);
};

#endif
