// SPDX-License-Identifier: MIT
// Penumbrae that grow from the edges of hard shadows over the picture.
#pragma once

#include "shadow/lookup/fake_penumbra/fake_penumbra.h"
#include "shadow/recipe/recipe.h"

namespace gn {

/// V from `shadows`, RGBA32F as large as the view: where the red channel is 1 the sample lies in shadow, and what casts it stands
/// as many metres before it as green says, packed.
Visibility add_fake_flood(const FrameInput& input, const GnFakePenumbraParams& params, TextureHandle shadows);

/// The distances in pixels, one for each pass, at which neighbours hand on the edges they know: one a pass, or by halves.
std::vector<int> flood_strides(int radius, bool jump);

}  // namespace gn
