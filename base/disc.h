// SPDX-License-Identifier: MIT
// Based on: Peter Shirley, Kenneth Chiu. A Low Distortion Map Between Disk and Square. JGT 1997. [SC97]
#pragma once

#include "base/math.h"

namespace gn {

/// Concentric map of the square onto the unit disc. [SC97, section 3]
inline vec2 disc_from_square(vec2 u) {
    const float a = 2.0F * u.x - 1.0F;
    const float b = 2.0F * u.y - 1.0F;
    const bool wide = std::abs(a) > std::abs(b);
    const float radius = wide ? a : b;
    const float ratio = radius != 0.0F ? (wide ? b : a) / radius : 0.0F;

    // Sine and cosine of pi/4 * ratio, by their series: the first term left out is under 2e-9.
    const float x = 0.25F * pi * ratio;
    const float x2 = x * x;
    const float sine = x * (1.0F + x2 * (-1.0F / 6 + x2 * (1.0F / 120 + x2 * (-1.0F / 5040 + x2 * (1.0F / 362880)))));
    const float cosine =
        1.0F + x2 * (-0.5F + x2 * (1.0F / 24 + x2 * (-1.0F / 720 + x2 * (1.0F / 40320 - x2 * (1.0F / 3628800)))));
    return radius * (wide ? vec2(cosine, sine) : vec2(sine, cosine));
}

/// A direction of a cone about the axis z of a frame, from a point of the unit disc. `height` is 1 - cosine of its half angle.
/// The height below the cone's pole is uniform (Archimedes), as is the squared radius on the disc.
inline vec3 direction_in_cone(vec2 disc, float height, vec3 x, vec3 y, vec3 z) {
    const float below = glm::dot(disc, disc) * height;
    return (1.0F - below) * z + std::sqrt(height * (2.0F - below)) * (disc.x * x + disc.y * y);
}
/// 1 - cosine of an angle, without cancellation.
inline float cone_height(float angle) {
    const float sine = std::sin(0.5F * angle);
    return 2.0F * sine * sine;
}

}  // namespace gn
