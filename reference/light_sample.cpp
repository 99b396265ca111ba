// SPDX-License-Identifier: MIT
#include "reference/light_sample.h"

#include <algorithm>
#include <limits>

namespace gn {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

float square(float x) {
    return x * x;
}

/// 1 inside the inner cone, 0 outside the outer one, a squared ramp of the cosine between (glTF KHR_lights_punctual).
float spot_falloff(const GnLight& light, float cosine) {
    const float width = std::max(1e-4F, light.cos_inner - light.cos_outer);
    return square(std::clamp((cosine - light.cos_outer) / width, 0.0F, 1.0F));
}

}  // namespace

LightSampler::LightSampler(const GnLight& light, vec3 p_ws) : light_(light) {
    centre_from_p_ = vec3(light.position_ws) - p_ws;
    switch (light.kind) {
        case GN_LIGHT_SPOT: {
            flat_ = disc_ = true;
            single_ = light.radius <= 0.0F;
            complete_frame(vec3(light.direction_ws), x_, y_);
            x_ *= light.radius;
            y_ *= light.radius;
            return;
        }
        case GN_LIGHT_RECTANGLE: {
            flat_ = true;
            single_ = light.half_size.x <= 0.0F && light.half_size.y <= 0.0F;
            x_ = light.half_size.x * vec3(light.right_ws);
            y_ = light.half_size.y * vec3(light.up_ws);
            return;
        }
        case GN_LIGHT_POINT: {
            single_ = light.radius <= 0.0F;
            distance_ = glm::length(centre_from_p_);
            axis_ = distance_ > 0.0F ? centre_from_p_ / distance_ : vec3(0, 1, 0);
            inside_ = !single_ && distance_ <= light.radius;
            // 1 - cos(asin(s)) without cancellation: s^2 / (1 + sqrt(1 - s^2)).
            const float s2 = inside_ || single_ ? 0.0F : square(light.radius / distance_);
            height_ = inside_ ? 2.0F : s2 / (1.0F + std::sqrt(1.0F - s2));
            break;
        }
        default: {
            single_ = light.angular_radius <= 0.0F;
            distance_ = infinity;
            axis_ = -vec3(light.direction_ws);
            height_ = cone_height(std::min(light.angular_radius, pi));
            break;
        }
    }
    complete_frame(axis_, x_, y_);
}

LightPoint LightSampler::in_cone(vec2 u) const {
    const vec2 d = disc_from_square(u);
    const float below = glm::dot(d, d) * height_;
    const vec3 direction = direction_in_cone(d, height_, x_, y_, axis_);
    if (light_.kind != GN_LIGHT_POINT) {
        return {direction, infinity};
    }

    // End where the direction meets the sphere first: on its far side only from inside.
    const float along = distance_ * (1.0F - below);
    const float across2 = square(distance_) * below * (2.0F - below);
    const float chord = std::sqrt(std::max(0.0F, square(light_.radius) - across2));
    return {direction, inside_ ? along + chord : std::max(0.0F, along - chord)};
}

float LightSampler::irradiance(const LightPoint& point, vec3 n_ws) const {
    const float cosine = std::max(0.0F, glm::dot(n_ws, point.direction_ws));
    const float emitted = -glm::dot(point.direction_ws, vec3(light_.direction_ws));
    switch (light_.kind) {
        case GN_LIGHT_SPOT: {
            // Candela spread evenly over the disc, every point with the spot's own falloff.
            return light_.intensity * cosine * spot_falloff(light_, emitted) / square(point.distance);
        }
        case GN_LIGHT_RECTANGLE: {
            const float area = 4.0F * light_.half_size.x * light_.half_size.y;
            return light_.intensity * area * cosine * std::max(0.0F, emitted) / square(point.distance);
        }
        case GN_LIGHT_POINT: {
            // Radiance I / (pi r^2) over a solid angle of 2 pi h, with r^2 = d^2 h (2 - h): I * 2 / (d^2 (2 - h)).
            // From inside, the sphere's radiance over all directions.
            return inside_ ? light_.intensity * cosine * 4.0F / square(light_.radius)
                           : light_.intensity * cosine * 2.0F / (square(distance_) * (2.0F - height_));
        }
        default: {
            // Radiance E / (pi sin^2) over a solid angle of 2 pi h, with sin^2 = h (2 - h): E * 2 / (2 - h).
            return light_.intensity * cosine * 2.0F / (2.0F - height_);
        }
    }
}

LightPoint sample_light(const GnLight& light, vec3 p_ws, vec2 u) {
    const LightSampler sampler(light, p_ws);
    return sampler.single() ? sampler.centre() : sampler.at(u);
}

}  // namespace gn
