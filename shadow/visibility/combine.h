// SPDX-License-Identifier: MIT
// Two V as one: of a map and of a direct part, of opaque and of translucent casters.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// The product of both or the smaller of them, sample by sample; with three channels where one of them has three. What is told
/// beside V is the first one's.
Visibility add_combined(const FrameInput& input, const Visibility& first, const Visibility& second, Combine combine);

}  // namespace gn
