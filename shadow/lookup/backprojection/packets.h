// SPDX-License-Identifier: MIT
// The lookup of receivers in packets.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// V by an invocation for each `backprojection.packet` squared pixels. `needs`: what the lookup reads, in order; `prologue`: what
/// stands before its GLSL.
Visibility add_packets(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map,
                       std::span<const std::string_view> needs, const std::string& prologue);

}  // namespace gn
