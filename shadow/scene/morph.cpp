// SPDX-License-Identifier: MIT
#include "shadow/scene/morph.h"

#include <algorithm>

namespace gn {

void add_targets(std::span<const MorphTarget> targets, std::span<const double> weights, Morphed& morphed) {
    std::vector<dvec3>& normals_os = morphed.normals_os;
    std::vector<bool> given, turned(normals_os.size(), false);
    for (const dvec3& n_os : normals_os) {
        given.push_back(n_os != dvec3(0));
    }
    for (std::size_t t = 0; t < std::min(targets.size(), weights.size()); ++t) {
        const double w = weights[t];
        if (w == 0 || !std::isfinite(w)) {
            continue;
        }
        const MorphTarget& target = targets[t];
        for (std::size_t i = 0; i < target.vertices.size(); ++i) {
            const std::uint32_t v = target.vertices[i];
            morphed.positions_os[v] += w * dvec3(target.positions_os[i]);
            if (v < given.size() && given[v] && target.normals_os[i] != vec3(0)) {
                normals_os[v] += w * dvec3(target.normals_os[i]);
                turned[v] = true;
            }
        }
    }
    for (std::size_t v = 0; v < normals_os.size(); ++v) {
        if (turned[v]) {
            const double length = glm::length(normals_os[v]);
            normals_os[v] = length > 0 && std::isfinite(length) ? normals_os[v] / length : dvec3(0);
        }
    }
}

}  // namespace gn
