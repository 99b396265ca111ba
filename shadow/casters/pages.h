// SPDX-License-Identifier: MIT
// Maps of pages that live over frames: of the tiles of a pool only some are drawn in a frame, others keep what they hold.
#pragma once

#include "shadow/casters/raster.h"

namespace gn {

/// The table (LightViews::tables) that holds the views to be drawn, of which LightViews::count exist.
inline constexpr std::string_view drawn_pages_table = "drawn";

/// Whether a placement's tiles are pages: `tiles`, `kept`, and that table.
bool are_pages(const LightViews& views);

/// The kept texture behind the depth attachment of such a map, by the name that LightViews::kept has. A placement asks for it
/// too, since its pages are as fresh as the texture.
TextureDesc page_pool(std::string_view name, std::uint32_t resolution, std::uint32_t layers = 1);

/// Clears and draws the views of the table into a map that is kept where there is a history, else into an empty one.
void add_page_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass);

}  // namespace gn
