// SPDX-License-Identifier: MIT
// Summed-area tables of what a map stores.
#pragma once

#include "gpu/frame_graph.h"
#include "shadow/map/sums_params.h"

namespace gn {

class PreparedRecipe;

struct SatTable {
    int table = GN_SAT_UINT32;    ///< GN_SAT_FLOAT32 or GN_SAT_UINT32
    int scan = GN_SAT_SCAN_AUTO;  ///< auto: serial on a CPU device, shared memory on a GPU
    int max_box = 64;             ///< side of the largest box that an integer table answers for, texels
};

/// Adds the passes that sum the first level of every layer of `source` over all texels up to and including each, read by
/// gn_sat_mean. Integer tables sum the first two components, in [0,1], and are RGBA16_UNORM (gn_sat_unpack); float tables
/// sum differences from gn_sat_centre, of all four components (RGBA32F) where the source has as many, else of two (RG32F).
/// `prepared` keeps the shaders, where there is one.
TextureHandle add_sat(FrameGraph& graph, TextureHandle source, const SatTable& options,
                      const PreparedRecipe* prepared = nullptr);

}  // namespace gn
