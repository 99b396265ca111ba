// SPDX-License-Identifier: MIT
// Based on: Blinn. Me and My (Fake) Shadow. IEEE Computer Graphics and Applications 1988. [Bli88]
#ifndef GN_SHADOW_DIRECT_PLANAR_H
#define GN_SHADOW_DIRECT_PLANAR_H

#include "base/shared.h"

struct GnPlanarParams {
    int planes GN_DEFAULT(4);             ///< most receiver planes
    float min_area GN_DEFAULT(0.02f);     ///< of the scene's surface that a plane must hold
    float tolerance GN_DEFAULT(1.0e-5f);  ///< of the scene's diagonal that a plane may be thick
};

#endif
