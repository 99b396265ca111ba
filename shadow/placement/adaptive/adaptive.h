// SPDX-License-Identifier: MIT
// Parameters of tiles at the resolution that the picture asks for, and what their choice is given.
#ifndef GN_SHADOW_PLACEMENT_ADAPTIVE_H
#define GN_SHADOW_PLACEMENT_ADAPTIVE_H

#include "base/shared.h"

#define GN_ADAPTIVE_RMSM 0
#define GN_ADAPTIVE_FVSM 1
#define GN_ADAPTIVE_TILED 2
#define GN_ADAPTIVE_ASM 3
#define GN_ADAPTIVE_QVSM 4

#define GN_ADAPTIVE_NONE 0
#define GN_ADAPTIVE_TILES 1
#define GN_ADAPTIVE_PLACES 2

struct GnAdaptiveParams {
    int mode GN_DEFAULT(GN_ADAPTIVE_RMSM);
    int maps GN_DEFAULT(4);                ///< the budget, in maps of the recipe's resolution
    int tile GN_DEFAULT(0);                ///< texels along a side of a tile with its border; 0: see adaptive.cpp
    int levels GN_DEFAULT(10);             ///< how often the map may be halved
    float density GN_DEFAULT(2.0f);        ///< texels that a pixel asks for
    int prepass GN_DEFAULT(256);           ///< fvsm: samples that are asked, along the picture's longer side
    int grid GN_DEFAULT(4);                ///< tiled: the level whose tiles have one resolution each
    int start GN_DEFAULT(3);               ///< asm, qvsm: the level that all samples get
    int rounds GN_DEFAULT(5);              ///< asm, qvsm: levels that are tried beyond it
    float threshold GN_DEFAULT(0.00002f);  ///< qvsm: share of the picture that must change in a tile; -1: none
    int kept GN_DEFAULT(GN_ADAPTIVE_NONE);
    float jitter GN_DEFAULT(0.0f);  ///< texels within which tiles move from frame to frame
};

/// What the choice of a tile is given.
struct GnAdaptiveData {
    vec4 eye_ws GN_DEFAULT(vec4(0.0f));   ///< the light's place; w = 1 where the maps are the six faces around it
    int levels GN_DEFAULT(0);             ///< of the finest tiles; at level l a map is 2^l x 2^l tiles
    float texels GN_DEFAULT(0.0f);        ///< along a side of a tile without its border
    float density GN_DEFAULT(0.0f);       ///< as in the parameters
    float reach_ws GN_DEFAULT(0.0f);      ///< metres that kernels reach beyond a receiver
    float reach_texels GN_DEFAULT(0.0f);  ///< texels of that which a tile's border holds
    int leaves GN_DEFAULT(0);             ///< 1: the finest tile at a place serves whatever lies there
};

#endif
