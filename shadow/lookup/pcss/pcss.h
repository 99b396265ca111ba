// SPDX-License-Identifier: MIT
// Parameters of percentage-closer soft shadows.
#ifndef GN_SHADOW_LOOKUP_PCSS_H
#define GN_SHADOW_LOOKUP_PCSS_H

#include "base/shared.h"

#define GN_PCSS_AVERAGE 0
#define GN_PCSS_NEAREST 1

#define GN_PCSS_TEXELS 0
#define GN_PCSS_BLOCKS 1

#define GN_PCSS_OF_PIXEL 0
#define GN_PCSS_OF_SURFACE 1

#define GN_PCSS_ONE_TEXEL 0
#define GN_PCSS_FOUR_TEXELS 1

#define GN_PCSS_VOGEL 0
#define GN_PCSS_POISSON 1
#define GN_PCSS_ROTATED_POISSON 2
#define GN_PCSS_GRID 3

struct GnPcssParams {
    int blocker GN_DEFAULT(GN_PCSS_AVERAGE);
    int search_taps GN_DEFAULT(16);
    int taps GN_DEFAULT(32);
    float density GN_DEFAULT(4.0f);
    float least GN_DEFAULT(1.5f);
    int early_out GN_DEFAULT(1);
    int extremes GN_DEFAULT(GN_PCSS_TEXELS);
    int planes GN_DEFAULT(0);
    int rays GN_DEFAULT(0);
    float caged GN_DEFAULT(3.0f);
    int noise GN_DEFAULT(GN_PCSS_OF_SURFACE);
    int tap GN_DEFAULT(GN_PCSS_ONE_TEXEL);
    int kernel GN_DEFAULT(GN_PCSS_VOGEL);
    int seed GN_DEFAULT(1);
};

#endif
