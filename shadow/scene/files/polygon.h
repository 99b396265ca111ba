// SPDX-License-Identifier: MIT
// Cutting polygons into triangles.
#pragma once

#include "base/math.h"

#include <span>
#include <vector>

namespace gn {

/// Triangles of a polygon as indices into `corners`, winding kept: a fan where it is convex, by cutting ears where it
/// is not (up to 128 corners; beyond, a fan again). Fewer than three corners make none.
std::vector<uvec3> triangulate(std::span<const dvec3> corners);

}  // namespace gn
