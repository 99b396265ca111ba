// SPDX-License-Identifier: MIT
// The two ways of soft shadows on planes.
#pragma once

#include "shadow/direct/planar_soft/planar_soft.h"
#include "shadow/geometry/flattened.h"

namespace gn {

/// The mean of the hard shadows of the light's points.
Visibility add_accumulated(const FrameInput& input, const ReceiverPlanes& found, const GnPlanarSoftParams& params);
/// The centre's hard shadow in a picture of each plane, blurred there.
Visibility add_blurred(const FrameInput& input, const ReceiverPlanes& found, const GnPlanarSoftParams& params);

}  // namespace gn
