// SPDX-License-Identifier: MIT
// Six views around a light; other placements fall back to it.
#pragma once

#include "shadow/placement/receivers.h"

namespace gn {

/// Faces +x -x +y -y +z -z, each wider than 90 degrees by the kernels' reach.
void add_cube_views(LightViews& views, const FrameInput& input, const Recipe& recipe);

}  // namespace gn
