// SPDX-License-Identifier: MIT
// A ground under a model that brings none: without one it shadows nothing but itself.
#pragma once

#include "shadow/scene/scene.h"

namespace gn {

/// Whether the scene has a floor of its own: within a hundredth of its size above its lowest point, faces that look up have
/// more than half the area of its footprint. Strays far from the main mass do not count.
bool has_floor(const Scene& scene);

/// Adds the plane that the options ask for to a finished scene, with a note. It is wide enough for the shadow of a sun 20
/// degrees high. Under a model it lies a little below the lowest point, so that it does not flicker through faces there.
/// The cameras of which `automatic` holds see to its end.
void add_ground(Scene& scene, const Ground& ground, const std::vector<bool>& automatic);

}  // namespace gn
