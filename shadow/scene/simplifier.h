// SPDX-License-Identifier: MIT
// Simplifies meshes, where the program links a library that does. What a renderer embeds stands without one.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gn {

/// Some triangles of a scene by themselves.
struct OwnMesh {
    std::vector<std::uint32_t> vertices;  ///< of the scene, ascending
    std::vector<vec3> positions_ws;       ///< of each of these
    std::vector<std::uint32_t> indices;   ///< three a triangle, into them
};
/// Of triangles given as three indices each into the scene's positions.
OwnMesh own_mesh(std::span<const vec3> positions_ws, std::vector<std::uint32_t> indices);

/// What edge collapses left of a mesh.
struct Simplified {
    std::vector<std::uint32_t> indices;  ///< three a triangle, of the same vertices
    float error = 0;                     ///< how far they moved its surface, metres
};
/// Of `indices`, three a triangle, at most `wanted` are asked for; more are left where fewer would move the surface by more than
/// `most_error` of the mesh's size. Neither span is empty.
using Simplifier = Simplified (*)(std::span<const vec3> positions, std::span<const std::uint32_t> indices,
                                  std::size_t wanted, float most_error);
/// The program's; null where it links none. gnomon::gn_shadow brings one, which registers itself.
Simplifier& simplifier();

}  // namespace gn
