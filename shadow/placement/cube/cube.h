// SPDX-License-Identifier: MIT
// Parameters of six faces around a light.
#ifndef GN_SHADOW_PLACEMENT_CUBE_H
#define GN_SHADOW_PLACEMENT_CUBE_H

#include "base/shared.h"

#define GN_CUBE_EQUAL 0
#define GN_CUBE_COVERAGE 1

#define GN_CUBE_GUARD 0
#define GN_CUBE_CROSS 1

struct GnCubeParams {
    int resolution GN_DEFAULT(GN_CUBE_EQUAL);
    int edges GN_DEFAULT(GN_CUBE_GUARD);
};

#endif
