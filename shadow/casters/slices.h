// SPDX-License-Identifier: MIT
// What of each slice of the scene, as shadow/receiver/slices.glsl cuts it, casts onto the slice's bottom.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

inline constexpr int most_slices = 16;

/// RGBA16F, as large as the views' layers: for each of them (count + 3) / 4 layers, whose channels hold four slices in turn, nearest
/// the light first; 1 where anything in the slice hides the light, else 0. Draws all casters once. Throws Refusal where a renderer
/// draws its casters itself.
TextureHandle add_slices(const FrameInput& input, const Recipe& recipe, const LightViews& views, int count);

}  // namespace gn
