// SPDX-License-Identifier: MIT
#include "apps/compare/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gn {
namespace {

/// Stops at magnitudes 0, 1/3, 2/3 and 1 of the square-rooted scale.
using Ramp = std::array<vec3, 4>;
const Ramp too_dark{vec3(0.075F, 0.082F, 0.095F), vec3(0.10F, 0.24F, 0.52F), vec3(0.24F, 0.53F, 0.93F),
                    vec3(0.74F, 0.88F, 1.0F)};
const Ramp too_light{vec3(0.075F, 0.082F, 0.095F), vec3(0.44F, 0.16F, 0.07F), vec3(0.90F, 0.44F, 0.13F),
                     vec3(1.0F, 0.89F, 0.62F)};

vec3 along(const Ramp& ramp, float t) {
    const float position = std::clamp(t, 0.0F, 1.0F) * 3.0F;
    const auto stop = std::min<std::size_t>(static_cast<std::size_t>(position), 2);
    return glm::mix(ramp[stop], ramp[stop + 1], position - static_cast<float>(stop));
}

void put(Image& image, int x, int y, vec3 color) {
    for (int c = 0; c < 3; ++c) {
        image.at(x, y, c) = color[c];
    }
}

}  // namespace

vec3 error_color(float signed_error) {
    return along(signed_error < 0 ? too_dark : too_light, std::sqrt(std::abs(signed_error)));
}

Image error_map(std::span<const float> signed_error, std::span<const std::uint8_t> counted, int width, int height) {
    const vec3 uncounted(0.20F), hatch(0.24F);
    Image map(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t p =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            const vec3 outside = (x + y) % 8 < 2 ? hatch : uncounted;
            put(map, x, y, counted[p] != 0 ? error_color(signed_error[p]) : outside);
        }
    }
    return map;
}

Image error_scale() {
    constexpr int width = 801;
    Image strip(width, 1, 3);
    for (int x = 0; x < width; ++x) {
        // Even steps of the square root, so that small errors get their room.
        const float position = 2.0F * static_cast<float>(x) / (width - 1) - 1.0F;
        put(strip, x, 0, error_color(position * std::abs(position)));
    }
    return strip;
}

}  // namespace gn
