// SPDX-License-Identifier: MIT
#ifndef GN_SHADOW_DIRECT_HYBRID_VOLUMES_H
#define GN_SHADOW_DIRECT_HYBRID_VOLUMES_H

#include "base/shared.h"

struct GnHybridVolumesParams {
    int band GN_DEFAULT(1);   ///< texels on either side of a sample that must agree for the map to decide
    int alpha GN_DEFAULT(1);  ///< 1: masked casters by their alpha; 0: whole
};

#endif
