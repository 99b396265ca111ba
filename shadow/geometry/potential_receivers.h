// SPDX-License-Identifier: MIT
// The potential shadow receivers PSR = L ∩ V ∩ S as a convex body, and how far a light must see for them.
//
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
#pragma once

#include "shadow/geometry/convex_body.h"
#include "shadow/stages.h"

#include <optional>
#include <vector>

namespace gn {

/// What potential_receivers and seen_bounds found for a light of a frame, by the size of the picture: placement asks, the
/// lookup asks, and so does every light that serves it.
struct LightReach {
    struct Found {
        uvec2 size;
        std::optional<Box> seen_ws;
        std::optional<ConvexBody> receivers;
    };
    std::vector<Found> found;
};
/// The input with a place to remember them in.
FrameInput remembering(const FrameInput& input);

/// The bounds of what the camera can see: of the scene's clusters that meet its frustum, so that a triangle that strayed
/// far away widens no map and no depth range. All of the scene where the camera sees none.
Box seen_bounds(const FrameInput& input);

/// L ∩ V ∩ S for the whole view: what the light reaches of what the camera sees of the scene's box.
ConvexBody potential_receivers(const FrameInput& input);
/// The same between two distances along the camera's axis (one cascade).
ConvexBody potential_receivers(const FrameInput& input, double near, double far);

/// L ∩ S: what the light reaches of the box around what the camera can see, wherever in it the camera looks.
ConvexBody lit_bounds(const FrameInput& input);

/// Distance from a point to the farthest corner of the box.
double farthest(const Box& box_ws, vec3 p_ws);
/// How far a light with a position must see: to the farthest of what the camera can see, or to the light's range, beyond
/// which no sample counts.
double reach_of(const FrameInput& input);

}  // namespace gn
