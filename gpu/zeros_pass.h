// SPDX-License-Identifier: MIT
// A pass that empties buffers.
#pragma once

#include "gpu/frame_graph.h"

#include <string>
#include <utility>
#include <vector>

namespace gn {

/// Every word of the buffers is 0 behind it.
inline void add_zeros(FrameGraph& graph, std::string name, const std::vector<BufferHandle>& buffers) {
    graph.add_pass(
        std::move(name),
        [&](PassBuilder& pass) {
            for (const BufferHandle buffer : buffers) {
                pass.copy_to(buffer);
            }
        },
        [buffers](Recorder& r) {
            for (const BufferHandle buffer : buffers) {
                r.fill(buffer, 0);
            }
        });
}

}  // namespace gn
