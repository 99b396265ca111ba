// SPDX-License-Identifier: MIT
// Based on: Assarsson, Akenine-Moller. A Geometry-Based Soft Shadow Volume Algorithm Using Graphics Hardware. TOG 2003. [AA03]
#ifndef GN_SHADOW_DIRECT_SOFT_VOLUMES_H
#define GN_SHADOW_DIRECT_SOFT_VOLUMES_H

#include "base/shared.h"

#define GN_SOFT_VOLUMES_EXACT 0
#define GN_SOFT_VOLUMES_TABLE 1

#define GN_SOFT_VOLUMES_ONE 0
#define GN_SOFT_VOLUMES_FOUR 1

struct GnSoftVolumesParams {
    int coverage GN_DEFAULT(GN_SOFT_VOLUMES_EXACT);
    int table GN_DEFAULT(16);                     ///< entries along each of the table's four axes
    int regions GN_DEFAULT(GN_SOFT_VOLUMES_ONE);  ///< four: what is hidden is summed by quarters of the light [FBP06]
    int bounded GN_DEFAULT(0);  ///< 1: no more is hidden, or shown, than the box around it on the light holds [FBP06]
    int closed GN_DEFAULT(1);   ///< 1: a solid casts with one side of its surface only
};

#endif
