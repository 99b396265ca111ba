// SPDX-License-Identifier: MIT
// Parameters of logarithmic perspective shadow maps.
#ifndef GN_SHADOW_PLACEMENT_LOGPSM_H
#define GN_SHADOW_PLACEMENT_LOGPSM_H

#include "base/shared.h"

struct GnLogpsmParams {
    float near GN_DEFAULT(0.005f);  ///< of the farthest depth: receivers nearer than this do not steer the warp
    float eta
        GN_DEFAULT(1.0f);  ///< strength of the perspective where view and light are perpendicular: -1 uniform, 0 as
                           ///< light space perspective maps, 1 the same error across the view everywhere
};

#endif
