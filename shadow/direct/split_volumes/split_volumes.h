// SPDX-License-Identifier: MIT
#ifndef GN_SHADOW_DIRECT_SPLIT_VOLUMES_H
#define GN_SHADOW_DIRECT_SPLIT_VOLUMES_H

#include "base/shared.h"

#define GN_SPLIT_VOLUMES_DEPTH 0
#define GN_SPLIT_VOLUMES_RANDOM 1

struct GnSplitVolumesParams {
    int split GN_DEFAULT(GN_SPLIT_VOLUMES_DEPTH);  ///< where a sample is counted before it: by depth, or by chance
    int tile GN_DEFAULT(64);                       ///< side, in pixels, of the tiles that share a splitting depth
    int alpha GN_DEFAULT(1);                       ///< 1: masked casters by their alpha; 0: whole
};

#endif
