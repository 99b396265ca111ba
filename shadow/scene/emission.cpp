// SPDX-License-Identifier: MIT
#include "shadow/scene/emission.h"

#include "base/error.h"
#include "shadow/scene/model.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gn {
namespace {

/// Linear values of all bytes.
const std::array<float, 256>& linear_of_bytes() {
    static const std::array<float, 256> values = [] {
        std::array<float, 256> made{};
        for (std::size_t i = 0; i < made.size(); ++i) {
            made.at(i) = linear_from_srgb(static_cast<float>(i) / 255.0F);
        }
        return made;
    }();
    return values;
}

vec3 texel(const Image8& picture, int x, int y) {
    const auto index =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
    const std::array<float, 256>& linear = linear_of_bytes();
    return {linear[picture.rgba[index]], linear[picture.rgba[index + 1]], linear[picture.rgba[index + 2]]};
}

}  // namespace

vec3 emission_at(const Image8& picture, vec2 place) {
    const vec2 last(picture.width - 1, picture.height - 1);
    const vec2 at = clamp(place * vec2(picture.width, picture.height) - 0.5F, vec2(0), last);
    const ivec2 low(at);
    const ivec2 high = min(low + 1, ivec2(last));
    const vec2 t = at - vec2(low);
    return mix(mix(texel(picture, low.x, low.y), texel(picture, high.x, low.y), t.x),
               mix(texel(picture, low.x, high.y), texel(picture, high.x, high.y), t.x), t.y);
}

vec3 mean_emission(const Image8& picture) {
    dvec3 sum(0);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            sum += dvec3(texel(picture, x, y));
        }
    }
    return vec3(sum / (static_cast<double>(picture.width) * picture.height));
}

const Image8* shown_picture(const Scene& scene, const GnLight& light) {
    const int texture = gn_emission_texture(light);
    const bool shown = texture >= 0 && texture < static_cast<int>(scene.textures.size()) && gn_takes_emission(light);
    return shown ? &scene.textures[static_cast<std::size_t>(texture)].image : nullptr;
}

void complete_emission(Scene& scene, Light& light) {
    if (shown_picture(scene, light.shape) == nullptr) {
        set_emission(light.shape, -1);
        return;
    }
    add_note(
        scene.notes,
        fmt::format("Light '{}' shows a picture: view-samples, depth-complexity and backprojection with its bitmask "
                    "tell which part of it is hidden, all else how much of its area.",
                    light.name));
}

}  // namespace gn
