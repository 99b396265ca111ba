// SPDX-License-Identifier: MIT
// The edges of a scene's casters with the triangles around each: what silhouettes are found with.
//
// Vertices at bit-identical positions are one vertex here, whatever normals and texture coordinates divide them. An
// edge may have any number of triangles: one at a border, two on a surface, more where sheets meet.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gn {

/// Triangles connected through edges.
struct Component {
    Box bounds_ws;
    bool closed = false;     ///< every edge is run through as often in one direction as in the other: it bounds a solid
    int outward = 1;         ///< closed ones: +1 when the windings show outwards, -1 when inwards
    bool one_sided = false;  ///< some of its triangles cast from their front alone
    std::uint32_t triangles = 0;
};

struct EdgeList {
    static constexpr std::uint32_t no_component = ~0U;

    std::vector<uvec2> edges;                 ///< two vertex indices, in the edge's own direction
    std::vector<std::uint32_t> first;         ///< edges + 1 entries: where the edge's triangles begin in `around`
    std::vector<std::uint32_t> around;        ///< triangle * 2 + 1 when it runs against the edge's direction
    std::vector<std::uint32_t> component_of;  ///< per triangle; no_component for those that cast nothing
    std::vector<Component> components;
};

/// How a triangle casts.
enum : std::uint8_t { casts_nothing = 0, casts_from_both_sides = 1, casts_from_its_front = 2 };

/// Builds the list in O(n log n). `casts` has one byte a triangle; triangles with two equal corners are left out too.
EdgeList build_edges(std::span<const vec3> positions_ws, std::span<const uvec3> triangles,
                     std::span<const std::uint8_t> casts);

/// Per vertex the first vertex at the same position (-0 equals 0).
std::vector<std::uint32_t> weld(std::span<const vec3> positions_ws);

}  // namespace gn
