// SPDX-License-Identifier: MIT
// Refinement by what maps show: tiles of a level are drawn and looked at, and where they are not good enough the next level's are.
#pragma once

#include "shadow/placement/adaptive/tree_passes.h"
#include "shadow/recipe/recipe.h"

#include <functional>

namespace gn::adaptive {

/// What rounds of drawing found, before the last: uint[GnTreeConstants::nodes], above GnTreeConstants::threshold where a tile is to
/// be refined. `tiles_of` makes a round's tiles of what is known before it, and their views, which name their placement.
using TilesOf = std::function<LightViews(const GnTreeConstants&, BufferHandle changed, int round)>;
BufferHandle add_refinement(const FrameInput& input, const Recipe& recipe, const GnTreeConstants& constants, int rounds,
                            bool edges, const TilesOf& tiles_of);

}  // namespace gn::adaptive
