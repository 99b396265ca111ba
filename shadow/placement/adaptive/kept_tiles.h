// SPDX-License-Identifier: MIT
// What of a light's tiles outlives a frame: the maps that they are parts of, and what each square of the atlas holds.
#pragma once

#include "shadow/placement/adaptive/tree_passes.h"
#include "shadow/recipe/recipe.h"

#include <string>

namespace gn::adaptive {

/// All that makes a node's tile what it is, but for the casters: where two are alike, so are their tiles.
struct KeptTree {
    GnLight shape;  ///< of the light, without colour and intensity
    std::vector<GnLightView> maps;
    ViewKind kind = ViewKind::perspective;
    int tile = 0, border = 0, tiles = 0, levels = 0;
    std::uint64_t casting = 0;  ///< what casts, and how, beside the geometry
    std::uint64_t version = 0;  ///< of the geometry that the tiles were last drawn of
};

/// Whether the recipe asks for tiles that outlive frames and its map and lookup can do with them; the sentence why they cannot,
/// or "" where they can or nothing is asked.
bool keeps_tiles(const Recipe& recipe);
std::string why_not_kept(const Recipe& recipe);

/// What is known of a light's tree before its maps are chosen.
KeptTree tree_of(const FrameInput& input);
/// The tree that the frame before left of the light, if `now` has its light and atlas; else null.
const KeptTree* tree_before(const FrameInput& input, const Recipe& recipe, const KeptTree& now);
/// Whether its maps show all that fitted ones show.
bool serves(const KeptTree& before, const LightViews& fitted);

/// How a frame's tiles follow those of the frame before.
struct Keeping {
    History* history = nullptr;  ///< null: nothing outlives the frame
    std::string name;
    bool follows = false;  ///< the frame before left tiles of the same tree
    bool redrawn = false;
    std::vector<vec4> boxes_ws;  ///< KeptTiles
};
/// Leaves the tree to the next frame.
Keeping keep_tree(const FrameInput& input, const Recipe& recipe, KeptTree now);

/// Of one atlas, named after a round of refinement or, with -1, of those that lookups read.
KeptTiles kept_tiles(const FrameInput& input, const Keeping& keeping, const LightViews& atlas, int round);
/// Lets an atlas's views name what outlives the frame, and tells how many tiles the frame drew.
void keep_views(const FrameInput& input, const Keeping& keeping, const TreeTiles& made, int round, LightViews& views);

}  // namespace gn::adaptive
