// SPDX-License-Identifier: MIT
// Refinement by what maps show: tiles of a level are drawn and looked at, and where they are not good enough the next level's are.
#pragma once

#include "shadow/placement/adaptive/tree_passes.h"
#include "shadow/recipe/recipe.h"

#include <functional>

namespace gn::adaptive {

/// What rounds of drawing found, before the last: uint[GnTreeConstants::nodes], above GnTreeConstants::threshold where a tile is to
/// be refined. `views_of` makes the views of a round's tiles, which name their placement.
BufferHandle add_refinement(const FrameInput& input, const Recipe& recipe, const GnTreeConstants& constants, int rounds,
                            bool edges, const std::function<LightViews(const TreeTiles&)>& views_of);

}  // namespace gn::adaptive
