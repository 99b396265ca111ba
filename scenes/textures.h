// SPDX-License-Identifier: MIT
// Generated base-colour textures; each repeats seamlessly.
#pragma once

#include "shadow/scene/scene.h"

namespace gn::scenes {

/// Mottled stone or plaster around a linear colour; contrast 0 to 1; `streaks` stretches the mottling downwards.
Texture mottled_texture(std::string name, vec3 linear_rgb, float contrast, float streaks, std::uint32_t seed);
/// Wood grain along v.
Texture wood_texture(std::string name, vec3 linear_rgb, std::uint32_t seed);
/// Small waves along u on water: crests a little lighter, troughs darker.
Texture water_texture(std::string name, vec3 linear_rgb, std::uint32_t seed);
/// A twig with leaves on nothing: alpha is 0 or 1 but for the edge's one-texel ramp.
Texture twig_texture(std::string name, vec3 linear_rgb, std::uint32_t seed);

}  // namespace gn::scenes
