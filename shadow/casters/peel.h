// SPDX-License-Identifier: MIT
// Depth peeling: the surfaces under each texel one behind the other.
//
// Based on: Everitt. Interactive Order-Independent Transparency. NVIDIA 2001. [Eve01]
#pragma once

#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

namespace gn {

/// The nearest surfaces behind `previous`, a D32 map of the same views: of every caster both sides, whatever the recipe keeps.
/// Surfaces within the rasterizer's rounding of `previous` (gn_depth_epsilon) count as the same. 1 where there is none.
TextureHandle add_next_layer(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                             TextureHandle previous);

/// Layers that can be asked for.
inline constexpr int most_peeled = 16;
/// The `count` nearest surfaces, nearest first, R32F: layer v of the map has its layers v * count to v * count + count - 1.
TextureHandle add_peeled(const FrameInput& input, const Recipe& recipe, const LightViews& views, int count);

}  // namespace gn
