// SPDX-License-Identifier: MIT
// What casts: the one place that maps, volumes, planar shadows and the truth ask.
//
// An object casts unless it was told not to, or its material lets light through: until shadows have colours, glass casts
// nothing. A lamp spares its own bulb. A material with one side casts from that side only, as the light sees it.
#pragma once

#include "shadow/scene/scene.h"

namespace gn {

/// Whether an object throws shadows of a light; of any light where `light` is null.
bool casts(const Scene& scene, std::size_t object, const Light* light);
/// The objects that do, ascending.
std::vector<std::uint32_t> casters(const Scene& scene, const Light& light);

/// Whether the light that meets a material's surface goes on behind it: transmission, or a blended factor below 1 that no
/// texture cuts out (a texture with alpha makes a blended material a mask).
bool lets_light_through(const Scene& scene, const Material& material);

/// Whether the material shows, and casts with, one side only.
inline bool is_single_sided(const Scene& scene, const Object& object) {
    return !scene.materials[static_cast<std::size_t>(object.material)].double_sided;
}

}  // namespace gn
