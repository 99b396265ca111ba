// SPDX-License-Identifier: MIT
// The flat receivers of a scene.
#pragma once

#include "shadow/direct/planar/planar.h"
#include "shadow/scene/scene.h"

#include <vector>

namespace gn {

struct ReceiverPlane {
    vec4 plane_ws{0};  ///< unit normal, offset: dot(plane_ws, vec4(p_ws, 1)) is p's height, metres
    double share = 0;  ///< of the scene's surface
};

struct ReceiverPlanes {
    std::vector<ReceiverPlane> planes;  ///< largest first, at most params.planes, each at least params.min_area
    double largest = 0;                 ///< share of the largest flat part, kept or not
    float tolerance = 0;                ///< metres
};

/// Finds them in O(triangles * planes).
ReceiverPlanes receiver_planes(const Scene& scene, const GnPlanarParams& params);

}  // namespace gn
