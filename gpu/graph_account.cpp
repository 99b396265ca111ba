// SPDX-License-Identifier: MIT
#include "gpu/graph_account.h"

namespace gn {

GraphStatistics account(const GraphDeclaration& declaration, const GraphPlan& plan, std::span<const double> ms) {
    GraphStatistics statistics;
    for (const Turn& turn : turns_of(declaration, plan)) {
        const DeclaredPass& pass = declaration.passes[turn.pass->declared];
        const std::size_t i = statistics.passes.size();
        statistics.passes.push_back({pass.name, pass.group, i < ms.size() ? ms[i] : 0.0});
    }
    for (std::size_t i = 0; i < declaration.textures.size(); ++i) {
        const DeclaredTexture& texture = declaration.textures[i];
        if (plan.textures[i].used) {
            statistics.resources.push_back(
                {texture.desc.name, texture.group, texel_bytes(texture.desc), !texture.imported});
        }
    }
    for (std::size_t i = 0; i < declaration.buffers.size(); ++i) {
        const DeclaredBuffer& buffer = declaration.buffers[i];
        if (plan.buffers[i].used) {
            statistics.resources.push_back({buffer.desc.name, buffer.group, buffer.desc.bytes, !buffer.imported});
        }
    }
    statistics.transient_bytes = plan.transient_bytes();
    return statistics;
}

}  // namespace gn
