// SPDX-License-Identifier: MIT
// Whether a light's map fits into the device, asked before anything is drawn.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// Throws Refusal naming the light, the size of its map and the resolution that fits, where the device has no texture so
/// large or cannot allocate its bytes at once.
void check_map_memory(const FrameInput& input, const Recipe& recipe, TextureHandle map);

/// `problem`, with what would need less: for frames whose maps fit one by one and not together.
std::string with_less_memory(const std::string& problem, const Recipe& recipe);

}  // namespace gn
