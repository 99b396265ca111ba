// SPDX-License-Identifier: MIT
// What is known of views, bias and light when a shader is composed, told to its compiler: software computes what is
// multiplied by zero, and both sides of every choice, for each pixel.
#pragma once

#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"

#include <string>

namespace gn {

/// GLSL, after the text of sample_inputs: `GnLightView known_view(int)`, `GnBias known_bias()` and `GnLight known_whole()`,
/// which are the views, u.bias and u.whole with constants where these cannot differ. The text says all that it depends on.
std::string known_text(const FrameInput& input, const Recipe& recipe, const LightViews& views);

}  // namespace gn
