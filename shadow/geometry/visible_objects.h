// SPDX-License-Identifier: MIT
// What the camera sees of the scene's objects, by their bounds: tighter than the bounds of the whole scene.
#pragma once

#include "shadow/geometry/convex_body.h"
#include "shadow/stages.h"

#include <span>
#include <vector>

namespace gn {

/// Whether the scene's objects are all that the camera sees. Of a lent scene nobody knows: what receives may cast nothing.
bool knows_what_is_seen(const Scene& scene);

/// The corners, in world space, of what planes leave of a box; none where it lies outside. A flat box has a little thickness.
std::vector<dvec3> corners_within(const Box& box_ws, std::span<const Plane> planes);

/// Distance along the camera's axis, in metres, to the end of what is seen of the objects between two distances, by the
/// bounds of each; `near` where none is seen, `far` where nobody knows.
double farthest_seen(const FrameInput& input, double near, double far);

}  // namespace gn
