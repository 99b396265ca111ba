// SPDX-License-Identifier: MIT
// Components that stand wholly in the shadow of another one: their volumes lie within its volumes, and shade nothing more.
//
// Based on: Lloyd, Wendt, Govindaraju, Manocha. CC Shadow Volumes. EGSR 2004. [LWGM04]
// Departs from it: asked of exact geometry, one coverer at a time, where the paper asks a depth map seen from the light of all
// of them; what many cover together is not found, and what is found is so at any resolution.
#pragma once

#include "shadow/geometry/edges.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gn {

/// What components are asked of: all ws, the list with its components as build_edges made it.
struct CoverScene {
    std::span<const vec3> positions_ws;
    std::span<const uvec3> triangles;
    std::span<const std::uint8_t> casts;  ///< per triangle, as for build_edges
    const EdgeList& list;
    std::span<const std::uint32_t>
        forms;  ///< per component: GN_VOLUMES_ANY, _FRONT, _BACK or _NONE, of which it covers nothing
};
/// Per component 1 where one other component hides all of it, and `margin` metres around it, from the light (w = 1 a point, w = 0
/// the direction towards it). Only the 64 components that look largest from the light cover, and only those of at most 4096
/// triangles: what is missed is drawn.
std::vector<std::uint8_t> covered_components(const CoverScene& scene, vec4 light_ws, double margin);

}  // namespace gn
