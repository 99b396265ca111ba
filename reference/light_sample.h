// SPDX-License-Identifier: MIT
// Points of a light as one receiver sees it, from points of the unit square, area-preserving so that the sampler's
// stratification survives:
//
//   directional  uniform over the cone of angular_radius          rectangle  uniform over its area
//   spot         uniform over the disc across its axis            point      uniform over the cone its sphere subtends
//
// Distances end at the light's surface: for a point light on the near side of its sphere. From inside that sphere
// every direction meets it, so all directions are drawn.
#pragma once

#include "base/disc.h"
#include "reference/truth.h"

namespace gn {

/// One light as seen from one receiver: constants first, then cheap points.
class LightSampler {
  public:
    LightSampler(const GnLight& light, vec3 p_ws);

    /// Whether the light has no extent seen from here: one exact ray replaces all samples.
    [[nodiscard]] bool single() const { return single_; }
    [[nodiscard]] LightPoint at(vec2 u) const { return flat_ ? on_shape(u) : in_cone(u); }
    /// The point of a light without extent.
    [[nodiscard]] LightPoint centre() const { return flat_ ? towards(centre_from_p_) : LightPoint{axis_, distance_}; }
    /// What the point adds to the irradiance of a surface with normal n where it is visible, divided by the density of
    /// the samples: the mean over samples of V times this is [EASW09] eq. 1.3.
    [[nodiscard]] float irradiance(const LightPoint& point, vec3 n_ws) const;

  private:
    [[nodiscard]] static LightPoint towards(vec3 from_p) {
        const float distance = glm::length(from_p);
        return {from_p / distance, distance};
    }
    [[nodiscard]] LightPoint on_shape(vec2 u) const {
        const vec2 s = disc_ ? disc_from_square(u) : 2.0F * u - 1.0F;
        return towards(centre_from_p_ + s.x * x_ + s.y * y_);
    }
    [[nodiscard]] LightPoint in_cone(vec2 u) const;

    GnLight light_;
    bool single_ = false;
    bool flat_ = false;  ///< a disc or a rectangle; else a cone of directions
    bool disc_ = false;
    vec3 centre_from_p_{0};
    vec3 x_{0}, y_{0};     ///< flat: half axes, metres; cone: unit
    vec3 axis_{0};         ///< cone: unit, towards the centre
    float height_ = 0;     ///< cone: 1 - cosine of its half angle
    float distance_ = 0;   ///< cone: to the centre
    bool inside_ = false;  ///< cone: p is inside the sphere
};

}  // namespace gn
