// SPDX-License-Identifier: MIT
// Parameters of hybrid frustum-traced shadows.
#ifndef GN_SHADOW_VISIBILITY_HYBRID_FRUSTUM_H
#define GN_SHADOW_VISIBILITY_HYBRID_FRUSTUM_H

#include "base/shared.h"

#define GN_HYBRID_FRUSTUM_DISTANCE 0
#define GN_HYBRID_FRUSTUM_HARD 1
#define GN_HYBRID_FRUSTUM_SOFT 2

struct GnHybridFrustumParams {
    int by GN_DEFAULT(GN_HYBRID_FRUSTUM_DISTANCE);  ///< what the soft shadow weighs
    float narrow GN_DEFAULT(1.0f);                  ///< pixels across a penumbra up to which the shadow is hard
    float wide GN_DEFAULT(6.0f);                    ///< and from which on it is soft
};

#endif
