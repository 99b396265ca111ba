// SPDX-License-Identifier: MIT
// The passes that find which tiles of a quadtree the view samples ask for, and make the views that draw them.
#pragma once

#include "shadow/placement/adaptive/tree.h"
#include "shadow/stages.h"

#include <vector>

namespace gn::adaptive {

/// Tiles that outlive frames: each stays in its square of the atlas while it is asked for, and longer where nothing else needs it.
struct KeptTiles {
    /// R32_UINT, a texel a square, GN_TREE_ROW in a row: 1 + the node whose tile it holds, 0: none; behind these rows as many with
    /// all squares, the one unused for longest first.
    TextureHandle before, now;
    bool fresh = true;           ///< no square holds anything
    bool redrawn = false;        ///< what is held is drawn all the same
    std::vector<vec4> boxes_ws;  ///< where casters moved: centre and half sides, one after the other
};

/// Buffers that the passes write.
struct TreeTiles {
    BufferHandle views;   ///< GnLightView[GnTreeConstants::tiles]; of kept ones empty where there is no tile
    BufferHandle count;   ///< uint: how many of them there are; of kept ones, how many are drawn
    BufferHandle drawn;   ///< of kept ones, GnLightView[count]: those that are drawn
    BufferHandle pages;   ///< uint[GnTreeConstants::nodes]: 1 + the view of a node's tile, 0 without one
    BufferHandle counts;  ///< GnTreeCounts
};
/// `changed`: of add_refinement; invalid: every sample gets what it asks for.
/// `kept`: null where all tiles are drawn, side by side.
TreeTiles add_tree(const FrameInput& input, const GnTreeConstants& constants, BufferHandle changed,
                   const KeptTiles* kept);

}  // namespace gn::adaptive
