// SPDX-License-Identifier: MIT
// Simpler bodies that cast for solids: fewer triangles, moved inwards so that the solid's own surface stays out of their shadow.
//
// Based on: van Sambeek. Real-time Shadow Generation for 3D simulations using modern hardware. 2007. [Sam07] section 2.4.5
// Departs from it: made by edge collapses of the mesh itself, where the author makes them by hand.
#pragma once

#include "shadow/geometry/edges.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gn {

/// The mesh that casts.
struct ProxyMesh {
    std::vector<vec3> positions_ws;      ///< those of the scene, and behind them those of the bodies
    std::vector<uvec3> triangles;        ///< of what casts as it is, and of the bodies
    std::vector<std::uint8_t> casts;     ///< per triangle, as for build_edges
    std::vector<std::uint8_t> masked;    ///< per triangle
    std::vector<std::uint8_t> is_proxy;  ///< per triangle: it is no surface of the scene
    std::size_t solids = 0,
                replaced = 0;  ///< closed components of at least 32 triangles, and those that cast as bodies
    std::size_t triangles_before = 0, triangles_after = 0;  ///< of the replaced ones
};

/// What proxies are made of; all per triangle. `list` of the same triangles.
struct ProxySource {
    std::span<const vec3> positions_ws;
    std::span<const uvec3> triangles;
    std::span<const std::uint8_t> casts, masked;
    const EdgeList& list;
};
/// Solids keep about `share` of their triangles, in (0, 1), or more where that would displace them by more than a twentieth of their
/// size. What is open, masked or has one side, and what no edge collapse leaves closed, casts as it is.
ProxyMesh make_proxies(const ProxySource& source, float share);

}  // namespace gn
