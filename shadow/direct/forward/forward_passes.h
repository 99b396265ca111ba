// SPDX-License-Identifier: MIT
// The passes of forward shadow mapping after the light's depth map, in order.
#pragma once

#include "shadow/direct/forward/forward.h"
#include "shadow/recipe/recipe.h"

namespace gn {

/// GnForwardSample a pixel: every view sample in the light view that serves it.
BufferHandle add_forward_samples(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                                 const GnForwardParams& params);
/// One uint a pixel, in units of 1 / 65536: what all lit texels bring to it.
BufferHandle add_forward_splats(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                                TextureHandle depth, BufferHandle samples, const GnForwardParams& params);
/// V from the sums.
Visibility add_forward_resolve(const FrameInput& input, BufferHandle samples, BufferHandle light);

}  // namespace gn
