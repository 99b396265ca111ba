// SPDX-License-Identifier: MIT
// Parameters of view-sample mapping.
#ifndef GN_SHADOW_DIRECT_VIEW_SAMPLES_H
#define GN_SHADOW_DIRECT_VIEW_SAMPLES_H

#include "base/shared.h"

#define GN_VIEW_SAMPLES_EXACT 0
#define GN_VIEW_SAMPLES_TABLE 1

struct GnViewSamplesParams {
    int samples GN_DEFAULT(32);                  ///< points that stand for the light at a receiver
    int test GN_DEFAULT(GN_VIEW_SAMPLES_EXACT);  ///< the points themselves, or the left-sample map alone
    int angles GN_DEFAULT(128);                  ///< texels of the left-sample map around
    int offsets GN_DEFAULT(64);                  ///< texels of it across the light
    int patterns GN_DEFAULT(1);                  ///< pixels: side of the square whose pixels take patterns of their own
    int closed GN_DEFAULT(0);                    ///< leaves out faces of solids that all of the light sees
};

#endif
