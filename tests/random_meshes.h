// SPDX-License-Identifier: MIT
// Random meshes of five kinds, and what a direct part makes of them beside the traced hard shadow: closed and intersecting, welded
// rings, loose triangles, fans of sheets on one edge, faces that lie on each other.
#pragma once

#include "tests/direct_scenes.h"

#include <functional>
#include <string>

namespace gn::by_hand {

inline constexpr unsigned mesh_kinds = 5;
const char* mesh_kind_name(unsigned kind);

/// Meshes among random lights: two suns and two lamps, one of them next to the camera, one behind it along the axis.
Scene random_meshes(unsigned kind, unsigned seed);

/// Draws ten seeds of a kind, or 300 in a thorough run, at 120 x 90. No sample may be wrong that lies neither beside a shadow nor on a
/// triangle's border, in a thorough run, and else none at all; nor more than 1e-5 of them. `described` says which recipe it was.
void expect_random_meshes_as_traced(unsigned kind, const std::function<Recipe(unsigned seed)>& recipe_of,
                                    const std::function<std::string(unsigned seed)>& described);

/// Two sheets that share an edge at so small an angle that near it the farther one shows, whose front faces the viewer, before the back
/// of the nearer one: view samples push backs away by steps of the rasterizer. What shows lies in the shadow of what does not. Under a
/// sun and two lamps; `closed_by_a_wall`: a third sheet stands on the edge.
Scene hinge(float angle, bool closed_by_a_wall = false);

}  // namespace gn::by_hand
