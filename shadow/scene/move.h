// SPDX-License-Identifier: MIT
// Objects that move: their vertices, normals and bounds follow, and they say from where they came.
#pragma once

#include "shadow/scene/scene.h"

namespace gn {

/// Moves an object by an affine transform without mirroring: its points p_ws become moved_from_ws * p_ws, its normals and
/// bounds follow, and so do the scene's bounds. Its version is a new one, and now_from_first goes on by the move. Throws Error for an object that is not there, that shares vertices with another, or a
/// transform that mirrors, flattens or is not finite.
void move_object(Scene& scene, std::size_t object, const mat4& moved_from_ws);

}  // namespace gn
