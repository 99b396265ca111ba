// SPDX-License-Identifier: MIT
// Summed-area tables of a map of moments.
#pragma once

#include "gpu/frame_graph.h"
#include "shadow/map/sat_vsm/sat_vsm.h"

namespace gn {

struct SatTable {
    int table = GN_SAT_UINT32;    ///< GN_SAT_FLOAT32 or GN_SAT_UINT32
    int scan = GN_SAT_SCAN_AUTO;  ///< auto: serial on a CPU device, shared memory on a GPU
    int max_box = 64;             ///< side of the largest box that an integer table answers for, texels
};

/// Adds the passes that sum the first two components of every layer of `moments`, in [0,1], over all texels up to and
/// including each. Integer tables are RGBA16_UNORM (gn_sat_unpack), float tables RG32F of differences from
/// gn_sat_centre.
TextureHandle add_sat(FrameGraph& graph, TextureHandle moments, const SatTable& options);

}  // namespace gn
