// SPDX-License-Identifier: MIT
// A renderer's camera is a matrix; placements want a place, axes and angles.
#pragma once

#include "shadow/scene/scene.h"

namespace gn::embed {

/// The camera behind a matrix, and what turns its depth into metres along its axis: z = z_offset / (depth - z_scale) under a
/// perspective, z = z_offset + z_scale * depth under an orthographic camera.
struct LentCamera {
    Camera camera;
    double z_scale = 0, z_offset = 0;
};

/// cs_from_ws: Vulkan's clip space, y downwards. bounds_ws: of all that is seen; it ends an infinite range. Throws Error where
/// the matrix is no camera's, mirrors, or has pixels that are not square.
LentCamera camera_of(const mat4& cs_from_ws, bool reversed_depth, uint width, uint height, const Box& bounds_ws);

}  // namespace gn::embed
