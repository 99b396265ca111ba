// SPDX-License-Identifier: MIT
// What the passes share that make a quadtree's tiles on the GPU.
#ifndef GN_SHADOW_PLACEMENT_ADAPTIVE_TREE_H
#define GN_SHADOW_PLACEMENT_ADAPTIVE_TREE_H

#include "shadow/light_view.h"
#include "shadow/placement/adaptive/adaptive.h"
#include "shadow/scene/light.h"

#define GN_TREE_MAPS 6
#define GN_TREE_ROWS 16    // pixels of a column that an invocation takes
#define GN_TREE_RANKS 512  // steps of an eighth of a doubling that demands are told apart by; 0 is no demand
#define GN_TREE_BLOCK 256  // nodes that an invocation counts
#define GN_TREE_LANES 256  // invocations that add blocks up
#define GN_TREE_ROW 1024   // squares of the atlas in a row of what the next frame finds

struct GnTreeConstants {
    GnLight light;
    GnAdaptiveData data;
    GnLightView maps[GN_TREE_MAPS];  ///< the views of whole maps
    int count GN_DEFAULT(1);         ///< of maps
    int nodes GN_DEFAULT(0);         ///< of all maps
    int blocks GN_DEFAULT(0);
    int tiles GN_DEFAULT(0);   ///< the budget
    int tile GN_DEFAULT(0);    ///< texels along a side of a tile with its border
    int across GN_DEFAULT(0);  ///< tiles along a side of a layer
    int resolution GN_DEFAULT(0);
    float growth GN_DEFAULT(0.0f);    ///< what a demand counts for at the next coarser level
    int spare GN_DEFAULT(0);          ///< levels that may lack until a texel is larger than a pixel
    int grid GN_DEFAULT(-1);          ///< the level whose nodes have tiles of one level each; -1: none
    int start GN_DEFAULT(0);          ///< with refinement: the level that all samples get
    int limit GN_DEFAULT(0);          ///< likewise: the level that rounds have come to
    int threshold GN_DEFAULT(0);      ///< likewise: changes in a tile above which it is refined
    vec2 jitter GN_DEFAULT(vec2(0));  ///< texels by which every tile shows what lies beside it
    int step GN_DEFAULT(1);           ///< pixels from one that is asked to the next
    uvec2 size GN_DEFAULT(uvec2(0));  ///< of the lattice of pixels that are asked
};

/// Zeroed before every frame.
struct GnTreeCounts {
    int begins[GN_TREE_RANKS +
               1];  ///< tiles more (or less) that are needed where ranks from this one on have tiles of their own
    uint samples;   ///< that asked
    uint steep;     ///< of which a pixel is less than a texel of the finest level
    uint coarser;   ///< that the budget gives texels larger than a pixel
    int rank;       ///< the lowest that has tiles of its own
    uint wanted;    ///< tiles that all demands need
    uint used;      ///< tiles that there are
    uint held;      ///< of which an earlier frame left so many
    uint stale;     ///< and of these so many are drawn anew
};

#endif
