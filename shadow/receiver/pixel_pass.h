// SPDX-License-Identifier: MIT
// A compute pass with an invocation for every pixel.
#pragma once

#include "gpu/shader_inputs.h"

#include <memory>
#include <string>

namespace gn {

/// `shader` has groups of 8 x 8; it reads and writes what `inputs` declare, and leaves out pixels beyond the picture itself.
inline void add_pixel_pass(FrameGraph& graph, std::string name, const ShaderInputs& inputs,
                           const std::shared_ptr<const ComputeDesc>& shader, std::uint32_t width,
                           std::uint32_t height) {
    graph.add_pass(
        std::move(name), [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, width, height](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch_pixels(width, height);
        });
}

}  // namespace gn
