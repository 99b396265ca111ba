// SPDX-License-Identifier: MIT
// What a depth map keeps of its casters beyond the nearest face: `casters` in recipes.
//
//   all       the nearest surface
//   front     the nearest surface that faces the light
//   back      the nearest surface that faces away: second depth [WM94]
//   midpoint  half way between the two nearest surfaces [Woo92]
//   dual      the same, but at most bias.dual texels behind the nearest [WE03]
//   ids       the nearest surface, and beside it the object that it belongs to [HN85]
#pragma once

#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

namespace gn {

/// Objects that an id tells apart: as many as the view samples' two bytes.
inline constexpr std::size_t max_object_ids = 65536;

/// The depth map of recipe.casters. With ids it offers `ids` beside `depth`, R32F: the index into Scene::objects, or -1 where nothing casts.
ShadowMap add_caster_depth(const FrameInput& input, const Recipe& recipe, const LightViews& views);

}  // namespace gn
