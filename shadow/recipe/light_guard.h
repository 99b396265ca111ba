// SPDX-License-Identifier: MIT
// How far a lookup reads that takes the light for as large as it is.
#pragma once

#include "shadow/recipe/part.h"

namespace gn {

/// A caster's distance matters up to the light itself. How far penumbrae reach is known of suns: what the scene's height
/// allows. Under lamps views that touch go on in each other where their placement crosses; else they are widened by the light's
/// own size. `least`: half width of the narrowest kernel, texels.
Guard light_guard(const Light& light, const Box& bounds_ws, float least);

}  // namespace gn
