// SPDX-License-Identifier: MIT
// Parameters of layered attenuation maps.
#ifndef GN_SHADOW_MAP_LAYERED_ATTENUATION_H
#define GN_SHADOW_MAP_LAYERED_ATTENUATION_H

#include "base/shared.h"

struct GnLayeredAttenuationParams {
    int lights GN_DEFAULT(64);       ///< points of the light, a map each
    int layers GN_DEFAULT(4);        ///< surfaces under a texel that are kept
    float epsilon GN_DEFAULT(1.0f);  ///< texels between a receiver's plane and the layer that it is taken for
};

#endif
