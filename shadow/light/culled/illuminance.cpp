// SPDX-License-Identifier: MIT
#include "shadow/light/culled/illuminance.h"

#include "base/math.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gn::culled {
namespace {

/// Of the light's colour, as its intensity counts it (Rec. 709).
double brightness(const GnLight& light) {
    return static_cast<double>(light.intensity) * glm::dot(dvec3(light.color), dvec3(0.2126, 0.7152, 0.0722));
}

/// How far the light itself reaches from its centre, metres.
double own_radius(const GnLight& light) {
    return light.kind == GN_LIGHT_RECTANGLE ? glm::length(dvec2(light.half_size)) : static_cast<double>(light.radius);
}

}  // namespace

double most_illuminance(const GnLight& light, const Reach& reach) {
    if (light.kind == GN_LIGHT_DIRECTIONAL || light.kind == GN_LIGHT_ENVIRONMENT) {
        return brightness(light);
    }
    const double distance = reach.nearest - own_radius(light);
    if (distance <= 0) {
        return std::numeric_limits<double>::infinity();
    }
    const double candela =
        light.kind == GN_LIGHT_RECTANGLE
            ? brightness(light) * 4 * static_cast<double>(light.half_size.x) * static_cast<double>(light.half_size.y)
            : brightness(light);
    return candela / (distance * distance);
}

double least_illuminance(const GnLight& light, const Reach& reach) {
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        return brightness(light);
    }
    const bool bounded = light.kind != GN_LIGHT_POINT || light.range > 0;
    const double distance = reach.farthest + own_radius(light);
    return bounded || distance <= 0 ? 0.0 : brightness(light) / (distance * distance);
}

}  // namespace gn::culled
