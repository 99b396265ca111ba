// SPDX-License-Identifier: MIT
// What the choice of a hemisphere is given.
#ifndef GN_SHADOW_PLACEMENT_PARABOLOID_H
#define GN_SHADOW_PLACEMENT_PARABOLOID_H

#include "base/shared.h"

struct GnParaboloidData {
    vec4 eye_ws GN_DEFAULT(vec4(0));   ///< the light's place; w = 1 where there is a second hemisphere
    vec4 axis_ws GN_DEFAULT(vec4(0));  ///< of the first, unit; w = 0
};

#endif
