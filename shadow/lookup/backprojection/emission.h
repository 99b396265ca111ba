// SPDX-License-Identifier: MIT
// What the points of a light send that shows a picture, for its bitmask.
#pragma once

#include "shadow/stages.h"

namespace gn {

/// Whether the light whose V is asked for shows a picture. A piece of a light (`split`) shows none.
bool shows_picture(const FrameInput& input);
/// RGBA32F, one layer of gn_back_cells squared: the linear mean of the picture over each cell of the light, x along its right_ws,
/// y along its up_ws.
TextureHandle add_emission(const FrameInput& input);

}  // namespace gn
