// SPDX-License-Identifier: MIT
// The passes that find which tiles of a quadtree the view samples ask for, and make the views that draw them.
#pragma once

#include "shadow/placement/adaptive/tree.h"
#include "shadow/stages.h"

namespace gn::adaptive {

/// Buffers that the passes write.
struct TreeTiles {
    BufferHandle views;   ///< GnLightView[GnTreeConstants::tiles]
    BufferHandle count;   ///< uint: how many of them there are
    BufferHandle pages;   ///< uint[GnTreeConstants::nodes]: 1 + the view of a node's tile, 0 without one
    BufferHandle counts;  ///< GnTreeCounts
};
/// `changed`: of add_refinement; invalid: every sample gets what it asks for.
TreeTiles add_tree(const FrameInput& input, const GnTreeConstants& constants, BufferHandle changed);

}  // namespace gn::adaptive
