// SPDX-License-Identifier: MIT
// What casts: the one place that maps, volumes, planar shadows and the truth ask.
//
// An object casts unless it was told not to, or its material lets light through: glass casts a coloured shadow, which only
// recipes with a translucent map draw. A lamp spares its own bulb. A material with one side casts from that side only, as the
// light sees it.
#pragma once

#include "shadow/scene/scene.h"

namespace gn {

/// How an object throws shadows: not at all, as a whole, where its alpha is there, or by what its surface lets through.
enum class CasterClass : std::uint8_t { none, opaque, masked, translucent };
/// An object's class for a light; for any light where `light` is null.
CasterClass caster_class(const Scene& scene, std::size_t object, const Light* light);

/// Whether an object throws a shadow without colour: opaque or masked.
bool casts(const Scene& scene, std::size_t object, const Light* light);
/// The share of the light that goes on behind a material's surface, rgb in [0,1]: its base colour times its transmission, or
/// what a blended surface leaves uncovered. Textures are left out.
vec3 transmittance(const Material& material);
/// The objects that do, and those that are translucent, ascending.
std::vector<std::uint32_t> casters(const Scene& scene, const Light& light);
std::vector<std::uint32_t> translucent_casters(const Scene& scene, const Light& light);

/// Whether the light that meets a material's surface goes on behind it: transmission, or a blended factor below 1 that no
/// texture cuts out (a texture with alpha makes a blended material a mask).
bool lets_light_through(const Scene& scene, const Material& material);

/// Whether the material shows, and casts with, one side only.
inline bool is_single_sided(const Scene& scene, const Object& object) {
    return !scene.materials[static_cast<std::size_t>(object.material)].double_sided;
}

}  // namespace gn
