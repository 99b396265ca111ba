// SPDX-License-Identifier: MIT
// The smallest filter radius on the screen, which `smallest-radius` measures and `perceptual` reads a frame later.
#pragma once

#include "shadow/stages.h"

#include <memory>

namespace gn {

/// Bits of a positive float, on the light's plane (shadow/receiver/light_plane.glsl); 0 where no frame has answered yet. Null
/// without a history, and for samples of a light, which have no filter of their own.
std::shared_ptr<std::uint32_t> smallest_filter(const FrameInput& input);

}  // namespace gn
