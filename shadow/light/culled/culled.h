// SPDX-License-Identifier: MIT
// Parameters of the culling of lights.
#ifndef GN_SHADOW_LIGHT_CULLED_H
#define GN_SHADOW_LIGHT_CULLED_H

#include "base/shared.h"

struct GnCulledParams {
    float share GN_DEFAULT(0.01f);
};

#endif
