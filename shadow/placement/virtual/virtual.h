// SPDX-License-Identifier: MIT
// Parameters of virtual shadow maps, and what the choice of a page is given.
#ifndef GN_SHADOW_PLACEMENT_VIRTUAL_H
#define GN_SHADOW_PLACEMENT_VIRTUAL_H

#include "base/shared.h"

#define GN_VIRTUAL_64 0
#define GN_VIRTUAL_128 1

#define GN_VIRTUAL_MOST_LEVELS 12
#define GN_VIRTUAL_SIDE 64       // pages of a level's window along a side; a power of two
#define GN_VIRTUAL_WALKERS 4096  // invocations that walk the list of what samples ask for

struct GnVirtualParams {
    int page GN_DEFAULT(GN_VIRTUAL_128);
    int levels GN_DEFAULT(GN_VIRTUAL_MOST_LEVELS);
    float texels GN_DEFAULT(1.0f);
    float stretch GN_DEFAULT(4.0f);
    int drawn GN_DEFAULT(0);
    float jitter GN_DEFAULT(0.0f);  ///< texels within which pages move from frame to frame
};

struct GnVirtualData {
    vec4 eye_ws GN_DEFAULT(vec4(0.0f));  ///< the light's place; w = 1 where its views are the six faces around it
    int faces GN_DEFAULT(1);
    int levels GN_DEFAULT(1);
    float page GN_DEFAULT(128.0f);   ///< texels along a page's side, without its border
    float texels GN_DEFAULT(1.0f);   ///< along a pixel's side, that are asked for
    float stretch GN_DEFAULT(4.0f);  ///< a texel's longest side over the mean, that is asked for
};

#endif
