// SPDX-License-Identifier: MIT
// Where the nearest texel lies that stands behind a step of depth.
#pragma once

#include "gpu/frame_graph.h"

namespace gn {

/// RG16F, as `depth`: the way, in texels, from each texel to the nearest one that lies behind a step, at least within `radius`;
/// (1e4, 1e4) where there is none. A step is a difference to a neighbour that is four times what its other side differs by, so
/// that slanted surfaces have none.
TextureHandle add_steps(FrameGraph& graph, TextureHandle depth, int radius);

}  // namespace gn
