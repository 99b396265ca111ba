// SPDX-License-Identifier: MIT
// Parameters of trapezoidal shadow maps.
#ifndef GN_SHADOW_PLACEMENT_TSM_H
#define GN_SHADOW_PLACEMENT_TSM_H

#include "base/shared.h"

struct GnTsmParams {
    float near GN_DEFAULT(0.02f);  ///< of the farthest depth: receivers nearer than this do not steer the warp
    float focus GN_DEFAULT(0.0f);  ///< metres from the camera; 0: the geometric mean of nearest and farthest receiver
    float share GN_DEFAULT(0.8f);  ///< of the map that receivers nearer than the focus get
};

#endif
