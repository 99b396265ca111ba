// SPDX-License-Identifier: MIT
// Convex outlines of points of a plane.
#pragma once

#include "base/math.h"

#include <vector>

namespace gn {

/// The corners of the convex hull, counterclockwise, without points along its sides; none for a single point.
std::vector<dvec2> convex_hull(std::vector<dvec2> points);

}  // namespace gn
