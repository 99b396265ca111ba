// SPDX-License-Identifier: MIT
// Based on: Laine, Aila, Assarsson, Lehtinen, Akenine-Moller. Soft Shadow Volumes for Ray Tracing. ACM TOG 2005. [LAAL05]
#ifndef GN_SHADOW_DIRECT_DEPTH_COMPLEXITY_H
#define GN_SHADOW_DIRECT_DEPTH_COMPLEXITY_H

#include "base/shared.h"

#define GN_DEPTH_COMPLEXITY_BITS_8 0
#define GN_DEPTH_COMPLEXITY_BITS_16 1

#define GN_DEPTH_COMPLEXITY_ONE 0
#define GN_DEPTH_COMPLEXITY_THREE 1

#define GN_DEPTH_COMPLEXITY_POINTS 0
#define GN_DEPTH_COMPLEXITY_CENTRE 1

struct GnDepthComplexityParams {
    int samples GN_DEFAULT(32);                       ///< points of the light, each with a counter at every view sample
    int bits GN_DEFAULT(GN_DEPTH_COMPLEXITY_BITS_8);  ///< of a counter
    int votes GN_DEFAULT(GN_DEPTH_COMPLEXITY_THREE);  ///< points of the light whose volumes are counted
    int masked GN_DEFAULT(GN_DEPTH_COMPLEXITY_POINTS);  ///< where rays are sent through masked casters
    int closed GN_DEFAULT(1);                           ///< 1: a solid casts with one side of its surface only
};

#endif
