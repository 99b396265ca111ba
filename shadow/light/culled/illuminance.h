// SPDX-License-Identifier: MIT
// What a light gives to surfaces between two distances from it.
#pragma once

#include "shadow/scene/light.h"

namespace gn::culled {

/// Distances from a light's centre to what is seen, metres.
struct Reach {
    double nearest = 0, farthest = 0;
};

/// The most illuminance, in lux, of a surface anywhere in reach; infinite where the light may touch it.
double most_illuminance(const GnLight& light, const Reach& reach);
/// What it surely gives, in lux, to surfaces that face it; 0 of lights that a cone, a range or a side bounds, and of the sky.
double least_illuminance(const GnLight& light, const Reach& reach);

}  // namespace gn::culled
