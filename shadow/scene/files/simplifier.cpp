// SPDX-License-Identifier: MIT
// Edge collapses through meshoptimizer.
#include "shadow/scene/simplifier.h"

#include <meshoptimizer.h>

/// Whoever links this library refers to this name, so that the linker takes the file, and the file registers itself.
extern "C" {
extern const int gn_mesh_simplifier;
const int gn_mesh_simplifier = 1;
}

namespace gn {
namespace {

Simplified simplify(std::span<const vec3> positions, std::span<const std::uint32_t> indices, std::size_t wanted,
                    float most_error) {
    Simplified found{std::vector<std::uint32_t>(indices.size())};
    const float* floats = &positions.front().x;
    const std::size_t left = meshopt_simplify(found.indices.data(), indices.data(), indices.size(), floats,
                                              positions.size(), sizeof(vec3), wanted, most_error, 0U, &found.error);
    found.indices.resize(left);
    found.error *= meshopt_simplifyScale(floats, positions.size(), sizeof(vec3));
    return found;
}

[[maybe_unused]] const bool is_registered = [] {
    simplifier() = simplify;
    return true;
}();

}  // namespace
}  // namespace gn
