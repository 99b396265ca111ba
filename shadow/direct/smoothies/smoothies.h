// SPDX-License-Identifier: MIT
// Based on: Chan, Durand. Rendering Fake Soft Shadows with Smoothies. EGSR 2003. [CD03]
#ifndef GN_SHADOW_DIRECT_SMOOTHIES_H
#define GN_SHADOW_DIRECT_SMOOTHIES_H

#include "base/shared.h"

struct GnSmoothiesParams {
    float width GN_DEFAULT(1.0f);  ///< of the penumbra, times the light's own
};

#endif
