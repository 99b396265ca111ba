// SPDX-License-Identifier: MIT
// Based on: Akenine-Moller, Assarsson. Approximate Soft Shadows on Arbitrary Surfaces Using Penumbra Wedges. EGWR 2002. [AA02]
#ifndef GN_SHADOW_DIRECT_WEDGES_H
#define GN_SHADOW_DIRECT_WEDGES_H

#include "base/shared.h"

#define GN_WEDGES_ASIN 0
#define GN_WEDGES_ATAN 1

struct GnWedgesParams {
    int turn GN_DEFAULT(GN_WEDGES_ASIN);  ///< the angle by which front and back planes are turned
    int closed GN_DEFAULT(1);             ///< 1: a solid casts with one side of its surface only
};

#endif
