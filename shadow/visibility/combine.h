// SPDX-License-Identifier: MIT
// V of a map and V of a direct part as one.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// The product of both or the smaller of them, sample by sample.
Visibility add_combined(const FrameInput& input, const Visibility& mapped, const Visibility& direct, Combine combine);

}  // namespace gn
