// SPDX-License-Identifier: MIT
// The passes of a layered variance map, in order: draw depths, place the splits, warp.
#pragma once

#include "shadow/map/lvsm/lvsm.h"
#include "shadow/recipe/recipe.h"

namespace gn {

/// RG32F, with the samples asked for: linear depth, and the spread of its plane over a texel (0 without slope_moment).
TextureHandle add_depths(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                         const GnLvsmParams& params);

/// R32F, layers + 1 by one row a layer of the depths: the splits after some iterations of Lloyd's relaxation. They start
/// uniform, or where the last frame of the input's history left them.
TextureHandle add_lloyd(const FrameInput& input, TextureHandle depths, const GnLvsmParams& params);

/// The warped moments, two layers a texture, the layers of one map behind each other. `splits` may be invalid: uniform.
TextureHandle add_warp(const FrameInput& input, TextureHandle depths, TextureHandle splits, const GnLvsmParams& params);

}  // namespace gn
