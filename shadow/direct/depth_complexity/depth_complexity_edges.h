// SPDX-License-Identifier: MIT
// Edges that may be silhouettes from some point of a light.
#pragma once

#include "shadow/geometry/volume_passes.h"

namespace gn {

/// The scene's edges with a list of sides for add_edge_regions: every edge once, as it runs in EdgeList::edges, that is a silhouette
/// from any point of the input's light. `closed` as volumes have it.
VolumeBuffers add_light_silhouettes(const FrameInput& input, bool closed);

}  // namespace gn
