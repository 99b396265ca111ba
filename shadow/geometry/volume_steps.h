// SPDX-License-Identifier: MIT
// The draws that count volumes, one after the other.
#pragma once

#include "shadow/geometry/volume_passes.h"

namespace gn {

/// One draw, or with `indexed` those of opaque caps, from words of the buffer of draws.
struct Step {
    RasterDesc pipeline;
    std::uint32_t word = 0;
    bool indexed = false;
    std::uint32_t mark = 0;  ///< what the stencil holds where it counts, if it is asked
};

struct StepOptions {
    VolumeMode mode = VolumeMode::behind;
    bool far_caps = false;       ///< volumes have a cap at their far end
    bool alone = false;          ///< VolumeMarks::alone
    bool all_fragments = false;  ///< each fragment is one, wherever it lies
    bool sliced = false;         ///< volumes that count before the samples are cut to their runs
};
/// In the order to draw them, for a pass whose count is blended.
std::vector<Step> count_steps(const ShaderInputs& inputs, const StepOptions& options);
/// The strips at the edges that sides hang from, each fragment one.
std::vector<Step> silhouette_steps(const ShaderInputs& inputs);
void draw_steps(Recorder& r, const std::vector<Step>& steps, BufferHandle draws);
/// The same on both faces, with a dynamic reference.
StencilOps volume_stencil(VkCompareOp compare, VkStencilOp pass);

}  // namespace gn
