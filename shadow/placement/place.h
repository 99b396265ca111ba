// SPDX-License-Identifier: MIT
// The placement stage, as the frame and all that look into it run it.
#pragma once

#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

namespace gn {

/// The views of the input's light, by the placement that the recipe has for it, which they name. Throws Refusal.
LightViews place_views(const FrameInput& input, const Recipe& recipe);

}  // namespace gn
