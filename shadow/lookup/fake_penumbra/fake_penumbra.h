// SPDX-License-Identifier: MIT
// Parameters of penumbrae that are drawn around hard shadows.
#ifndef GN_SHADOW_LOOKUP_FAKE_PENUMBRA_H
#define GN_SHADOW_LOOKUP_FAKE_PENUMBRA_H

#include "base/shared.h"

#define GN_FAKE_RADIAL 0
#define GN_FAKE_WIDTH_MAP 1
#define GN_FAKE_FLOOD 2
#define GN_FAKE_JUMP_FLOOD 3

struct GnFakePenumbraParams {
    int form GN_DEFAULT(GN_FAKE_RADIAL);
    int radius GN_DEFAULT(64);
    float least GN_DEFAULT(0.0f);
};

#endif
