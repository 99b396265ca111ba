// SPDX-License-Identifier: MIT
#ifndef GN_SHADOW_DIRECT_VOLUMES_H
#define GN_SHADOW_DIRECT_VOLUMES_H

#include "base/shared.h"

#define GN_VOLUMES_Z_FAIL 0
#define GN_VOLUMES_Z_PASS 1
#define GN_VOLUMES_ZP_PLUS 2
#define GN_VOLUMES_AUTO 3

#define GN_VOLUMES_SILHOUETTE 0
#define GN_VOLUMES_BRUTE_FORCE 1

#define GN_VOLUMES_EXACT 0
#define GN_VOLUMES_OPAQUE 1
#define GN_VOLUMES_SKIP 2

struct GnVolumesParams {
    int mode GN_DEFAULT(GN_VOLUMES_AUTO);           ///< on which side of the sample volumes are counted
    int extrude GN_DEFAULT(GN_VOLUMES_SILHOUETTE);  ///< sides of silhouettes, or of every triangle
    int masked GN_DEFAULT(GN_VOLUMES_EXACT);        ///< alpha-masked casters: their texels, whole polygons, or nothing
    int closed GN_DEFAULT(1);                       ///< 1: a solid casts with one side of its surface only
    int clamp GN_DEFAULT(1);                        ///< 1: volumes end where no sample is beyond
    int slices GN_DEFAULT(0);        ///< 1: volumes are drawn where, by rows and columns, samples may be in them
    int culling GN_DEFAULT(1);       ///< 1: components whose shadow cannot be seen are left out
    int covered GN_DEFAULT(1);       ///< 1: components that stand wholly in another's shadow are left out
    float proxies GN_DEFAULT(0.0f);  ///< share of their triangles that solids cast with; 0: all
};

#endif
