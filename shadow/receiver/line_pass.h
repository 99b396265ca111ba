// SPDX-License-Identifier: MIT
// A compute pass with an invocation for every element of a list.
#pragma once

#include "gpu/shader_inputs.h"

#include <algorithm>
#include <memory>
#include <string>

namespace gn {

/// At least `count` invocations in groups of 64, as many rows of groups as a device's least limit asks for. A shader finds its own by
///
///     (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex
///
/// and leaves out those beyond the list itself.
inline void dispatch_line(Recorder& r, std::uint32_t count) {
    const std::uint32_t groups = std::max((count + 63) / 64, 1U);
    const std::uint32_t across = std::min(groups, 32768U);
    r.dispatch(across, (groups + across - 1) / across);
}

/// `shader` reads and writes what `inputs` declare.
inline void add_line_pass(FrameGraph& graph, std::string name, const ShaderInputs& inputs,
                          const std::shared_ptr<const ComputeDesc>& shader, std::uint32_t count) {
    graph.add_pass(
        std::move(name), [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, count](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            dispatch_line(r, count);
        });
}

}  // namespace gn
