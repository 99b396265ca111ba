// SPDX-License-Identifier: MIT
// What parts get to see of the frame, with other samples.
#pragma once

#include "shadow/stages.h"

namespace gn {

/// The same frame and light; `samples` must live as long as the graph.
FrameInput seen_by(const FrameInput& input, const ViewSamples& samples);

}  // namespace gn
