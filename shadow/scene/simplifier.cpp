// SPDX-License-Identifier: MIT
#include "shadow/scene/simplifier.h"

#include <algorithm>

namespace gn {

OwnMesh own_mesh(std::span<const vec3> positions_ws, std::vector<std::uint32_t> indices) {
    OwnMesh mesh{.vertices = indices, .positions_ws = {}, .indices = std::move(indices)};
    std::vector<std::uint32_t>& used = mesh.vertices;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& index : mesh.indices) {
        index = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), index) - used.begin());
    }
    for (const std::uint32_t vertex : used) {
        mesh.positions_ws.push_back(positions_ws[vertex]);
    }
    return mesh;
}

Simplifier& simplifier() {
    static Simplifier registered = nullptr;
    return registered;
}

}  // namespace gn
