// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// The lights of section 4.1.2 are spots with a cone and a size (3.2.1). A rectangle as wide may take their place.
// Departs from it: his size is a volume, a spot's here is a disc.
#pragma once

#include "scenes/analytic.h"

namespace gn::scenes {

/// Choices of the parameter `light`, in the order of its row.
inline constexpr int as_rectangle = 0, as_spot = 1;
inline constexpr std::string_view light_sentence =
    "Rectangles shine over half of space; spots have a cone that one map serves, and the same brightness and width.";

/// A light of a width that shines from `at` towards `target` with so many candela along its axis. `outer_degrees` is half the
/// angle of a spot's cone.
inline Light sized_light(int light, std::string name, vec3 at, vec3 target, float width, float candela,
                         float outer_degrees, vec3 color) {
    return light == as_spot
               ? spot_light(std::move(name), at, target, 0.5F * width, candela, outer_degrees, color)
               : rectangle_light(std::move(name), at, target, vec2(0.5F * width), candela / (width * width), color);
}

}  // namespace gn::scenes
