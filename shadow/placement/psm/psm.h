// SPDX-License-Identifier: MIT
// Parameters of perspective shadow maps.
#ifndef GN_SHADOW_PLACEMENT_PSM_H
#define GN_SHADOW_PLACEMENT_PSM_H

#include "base/shared.h"

struct GnPsmParams {
    float back GN_DEFAULT(0.03f);  ///< of the farthest depth: how far the virtual camera stands behind the real one
};

#endif
