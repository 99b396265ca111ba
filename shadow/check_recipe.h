// SPDX-License-Identifier: MIT
// The half of check_recipe (shadow/recipe.h) that needs neither scene nor device.
#pragma once

#include "shadow/recipe.h"

namespace gn {

/// Throws Error when a map stands without a lookup or a lookup without a map: no scene can be drawn with it.
void check_complete(const Recipe& recipe);

}  // namespace gn
