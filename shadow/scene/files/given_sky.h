// SPDX-License-Identifier: MIT
// What a file says of the light from everywhere, whatever its format. docs/scenes.md has the keys.
#pragma once

#include "base/math.h"
#include "shadow/scene/scene.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace gn {

inline constexpr std::array<std::string_view, 9> sky_keys{"name",  "radiance", "illuminance", "color", "above",
                                                          "below", "zenith",   "horizon",     "seen"};

/// Numbers by key; what is unset was not given.
struct GivenSky {
    std::string name;
    std::optional<double> radiance;                             ///< cd/m^2, the same from everywhere
    std::optional<double> illuminance;                          ///< lux, on a surface that faces up under a white sky
    std::optional<dvec3> color, above, below, zenith, horizon;  ///< linear rgb
    std::optional<double> seen;                                 ///< GnSky::seen
};

/// What is wrong with it, as the end of a sentence ("needs either ..."), or "".
std::string sky_mistake(const GivenSky& given);
/// The environment that it means: uniform where it names a radiance, else a pale sky over the ground, but for what it sets.
Light light_of(const GivenSky& given);

}  // namespace gn
