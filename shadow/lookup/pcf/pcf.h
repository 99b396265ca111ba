// SPDX-License-Identifier: MIT
// Parameters of percentage-closer filtering.
#ifndef GN_SHADOW_LOOKUP_PCF_H
#define GN_SHADOW_LOOKUP_PCF_H

#include "base/shared.h"

#define GN_PCF_2X2 0
#define GN_PCF_3X3 1
#define GN_PCF_NXN 2
#define GN_PCF_BILINEAR 3
#define GN_PCF_BILINEAR_NXN 4
#define GN_PCF_GAUSSIAN 5
#define GN_PCF_POISSON 6
#define GN_PCF_ROTATED_POISSON 7
#define GN_PCF_VOGEL 8

#define GN_PCF_OF_KERNEL 0
#define GN_PCF_OF_PIXEL 1

#define GN_PCF_ONE_TEXEL 0
#define GN_PCF_FOUR_TEXELS 1

#define GN_PCF_NO_EXTREMES 0
#define GN_PCF_TEXELS 1
#define GN_PCF_BLOCKS 2

struct GnPcfParams {
    int kernel GN_DEFAULT(GN_PCF_BILINEAR_NXN);
    int footprint GN_DEFAULT(GN_PCF_OF_KERNEL);
    int size GN_DEFAULT(3);
    int taps GN_DEFAULT(16);
    float radius GN_DEFAULT(2.0f);
    float radius_world GN_DEFAULT(0.0f);
    int early_out GN_DEFAULT(0);
    int seed GN_DEFAULT(1);
    int tap GN_DEFAULT(GN_PCF_ONE_TEXEL);
    int extremes GN_DEFAULT(GN_PCF_NO_EXTREMES);
};

#endif
