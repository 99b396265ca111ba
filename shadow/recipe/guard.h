// SPDX-License-Identifier: MIT
// How far kernels reach beyond a receiver, which views must be wider by.
#pragma once

#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"

namespace gn {

/// The kernels' reach of the recipe's map and lookup together.
Guard guard_of(const Recipe& recipe, const Light& light, const Box& bounds_ws);
Guard guard_of(const FrameInput& input, const Recipe& recipe);
/// Bounds of what casts, strays left out, which would make a kernel's reach theirs; of a lent scene those that its host gives.
Box main_bounds(const FrameInput& input);

/// Texels between a view's near plane and the nearest receiver: the bias and the cone move what is compared towards the
/// light, and what casts before the near plane is stored on it. Without this room flat receivers come before it.
inline double room_of(Guard guard) {
    return 2 + 2 * static_cast<double>(guard.texels);
}

}  // namespace gn
