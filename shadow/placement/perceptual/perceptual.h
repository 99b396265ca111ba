// SPDX-License-Identifier: MIT
// Parameters of the resolution that a filter asks for.
#ifndef GN_SHADOW_PLACEMENT_PERCEPTUAL_H
#define GN_SHADOW_PLACEMENT_PERCEPTUAL_H

#include "base/shared.h"

struct GnPerceptualParams {
    float c GN_DEFAULT(3.47f);
    float radius GN_DEFAULT(0.0f);
    float least GN_DEFAULT(0.0005f);
    float change GN_DEFAULT(0.25f);
};

#endif
