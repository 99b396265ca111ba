// SPDX-License-Identifier: MIT
// The flat receivers of a scene.
#pragma once

#include "shadow/stages.h"

#include <memory>
#include <vector>

namespace gn {

/// Which flat parts are receivers.
struct PlaneSearch {
    int planes = 4;           ///< the most
    float min_area = 0.02F;   ///< of the scene's surface that a plane must hold
    float tolerance = 1e-5F;  ///< of the scene's diagonal that a plane may be thick
};

struct ReceiverPlane {
    vec4 plane_ws{0};  ///< unit normal, offset: dot(plane_ws, vec4(p_ws, 1)) is p's height, metres
    double share = 0;  ///< of the scene's surface
};

struct ReceiverPlanes {
    std::vector<ReceiverPlane> planes;  ///< largest first, at most `planes`, each at least `min_area`
    double largest = 0;                 ///< share of the largest flat part, kept or not
    float tolerance = 0;                ///< metres
};

/// Finds them in O(triangles * planes).
ReceiverPlanes receiver_planes(const Scene& scene, const PlaneSearch& search);
/// The same, kept with the geometry. Throws Refusal, in the name of a part with these parameters, where there is none.
std::shared_ptr<const ReceiverPlanes> flat_receivers(const FrameInput& input, const PlaneSearch& search,
                                                     std::string_view part);

}  // namespace gn
