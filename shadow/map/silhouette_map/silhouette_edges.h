// SPDX-License-Identifier: MIT
// Silhouettes rasterized into cells.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// R32F, one layer a map layer: a packed point of the silhouette nearest to the light, or the cell's middle. `depth`
/// hides silhouettes that lie behind all four corners of a cell.
TextureHandle add_silhouette_points(const FrameInput& input, const LightViews& views, TextureHandle depth);

}  // namespace gn
