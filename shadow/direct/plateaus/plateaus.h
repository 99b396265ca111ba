// SPDX-License-Identifier: MIT
// Based on: Haines. Soft Planar Shadows Using Plateaus. Journal of Graphics Tools 2001. [Hai01]
#ifndef GN_SHADOW_DIRECT_PLATEAUS_H
#define GN_SHADOW_DIRECT_PLATEAUS_H

#include "base/shared.h"

struct GnPlateausParams {
    int planes GN_DEFAULT(4);             ///< most receiver planes
    float min_area GN_DEFAULT(0.02f);     ///< of the scene's surface that a plane must hold
    float tolerance GN_DEFAULT(1.0e-5f);  ///< of the scene's diagonal that a plane may be thick
};

#endif
