// SPDX-License-Identifier: MIT
#include "shadow/scene/files/given_sky.h"

#include <fmt/format.h>

#include <cmath>

namespace gn {
namespace {

constexpr double brightest = 1e9;  // cd/m^2 and lux: as of lights, beyond it products overflow
constexpr double strongest = 1e3;  // of colours and of the sky that is seen

bool within(double value, double most) {
    return std::isfinite(value) && value >= 0 && value <= most;
}

bool within(const dvec3& value, double most) {
    return within(value.x, most) && within(value.y, most) && within(value.z, most);
}

}  // namespace

std::string sky_mistake(const GivenSky& given) {
    if (given.radiance.has_value() == given.illuminance.has_value()) {
        return "needs either radiance (cd/m^2) or illuminance (lux)";
    }
    if (!within(given.radiance.value_or(0), brightest) || !within(given.illuminance.value_or(0), brightest)) {
        return fmt::format("{} must be from 0 to {:g}", given.radiance ? "radiance" : "illuminance", brightest);
    }
    for (const auto& [value, key] : {std::pair{given.color, "color"},
                                     {given.above, "above"},
                                     {given.below, "below"},
                                     {given.zenith, "zenith"},
                                     {given.horizon, "horizon"}}) {
        if (!within(value.value_or(dvec3(0)), strongest)) {
            return fmt::format("{} must be 3 numbers from 0 to {:g}", key, strongest);
        }
    }
    return within(given.seen.value_or(0), strongest) ? "" : fmt::format("seen must be from 0 to {:g}", strongest);
}

Light light_of(const GivenSky& given) {
    Light light{.name = given.name.empty() ? "environment" : given.name, .shape = {}};
    light.shape.kind = GN_LIGHT_ENVIRONMENT;
    // A surface under uniform radiance L gets the integral of L n.l over the hemisphere, pi L.
    constexpr double pi_d = 3.14159265358979323846;
    light.shape.intensity = static_cast<float>(given.radiance ? pi_d * *given.radiance : *given.illuminance);
    GnSky& sky = light.sky;
    if (given.radiance) {
        sky.above = sky.below = sky.zenith = sky.horizon = vec4(1, 1, 1, 0);
        sky.seen = 1;
    }
    for (const auto& [to, value] : {std::pair{&sky.above, given.above},
                                    {&sky.below, given.below},
                                    {&sky.zenith, given.zenith},
                                    {&sky.horizon, given.horizon}}) {
        *to = vec4(vec3(value.value_or(given.color.value_or(dvec3(1)) * dvec3(*to))), 0);
    }
    sky.seen = static_cast<float>(given.seen.value_or(static_cast<double>(sky.seen)));
    return light;
}

}  // namespace gn
