// SPDX-License-Identifier: MIT
// Cameras and lights that stand for all that a renderer may have, over a wall of 2 x 2 metres that stands on a floor of 8 x 8.
#pragma once

#include "shadow/scene/scene.h"

#include <array>

namespace gn::embed {

inline constexpr uint rehearsed_kinds = light_kind_names.size();
/// A point or a small light, and a large one; from aside, as the camera looks, against it, among what receives, and where it
/// reaches nothing.
inline constexpr std::size_t rehearsed_situations = 10;
inline const Box rehearsed_bounds_ws{vec3(-4, 0, -4), vec3(4, 2, 4)};

/// Clip space from 7 metres before the wall and 5 above the floor.
mat4 rehearsed_camera(bool orthographic, bool reversed);
/// A light of every kind in one of the situations: together, as a placement serves some and leaves others to another one.
std::array<GnLight, rehearsed_kinds> rehearsed_lights(std::size_t situation);

}  // namespace gn::embed
