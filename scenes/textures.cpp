// SPDX-License-Identifier: MIT
#include "scenes/textures.h"

#include "scenes/noise.h"

#include <algorithm>

namespace gn::scenes {
namespace {

constexpr int side = 256;

// IEC 61966-2-1, on 8 bits.
std::uint8_t encode(float linear) {
    const float c = std::clamp(linear, 0.0F, 1.0F);
    const float s = c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255 * s));
}

// Fills a square texture from a function of (u, v) in [0,1) that gives linear rgb and alpha.
template <class Shade>
Texture paint(std::string name, Shade&& shade) {
    Texture texture;
    texture.name = std::move(name);
    texture.image.width = texture.image.height = side;
    texture.image.rgba.reserve(4UL * side * side);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const vec4 c = shade((static_cast<float>(x) + 0.5F) / side, (static_cast<float>(y) + 0.5F) / side);
            texture.image.rgba.insert(texture.image.rgba.end(), {encode(c.x), encode(c.y), encode(c.z),
                                                                 static_cast<std::uint8_t>(std::lround(255 * c.w))});
        }
    }
    return texture;
}

std::uint32_t lattice(int x, int y, std::uint32_t seed) {
    std::uint32_t h =
        static_cast<std::uint32_t>(x) * 0x8da6b343U ^ static_cast<std::uint32_t>(y) * 0xd8163841U ^ seed * 0xcb1ab31fU;
    h = (h ^ (h >> 15U)) * 0x2c1b3c6dU;
    h = (h ^ (h >> 12U)) * 0x297a2d39U;
    return h ^ (h >> 15U);
}

// One leaf on the twig: an almond from `root` along `axis`, both in uv.
struct Leaf {
    vec2 root, axis;
    float width, tint;
};

std::vector<Leaf> twig_leaves(std::uint32_t seed) {
    Dice dice(seed);
    std::vector<Leaf> leaves;
    for (int i = 0; i < 11; ++i) {
        const float along = 0.10F + 0.072F * static_cast<float>(i);
        const float turn = (i % 2 == 0 ? 1.0F : -1.0F) * dice.between(0.75F, 1.15F) * (i == 10 ? 0.1F : 1.0F);
        const float length = dice.between(0.22F, 0.30F) * (1.05F - 0.35F * along);
        leaves.push_back({{0.5F + 0.03F * std::sin(9 * along), 1 - along},
                          length * vec2(std::sin(turn), -std::cos(turn)),
                          dice.between(0.38F, 0.48F),
                          dice.between(0.75F, 1.25F)});
    }
    return leaves;
}

}  // namespace

float value_noise(float x, float y, int period, std::uint32_t seed) {
    const auto wrap = [period](int i) { return ((i % period) + period) % period; };
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    const float fx = x - std::floor(x), fy = y - std::floor(y);
    const float sx = fx * fx * (3 - 2 * fx), sy = fy * fy * (3 - 2 * fy);
    const auto at = [&](int dx, int dy) {
        return static_cast<float>(lattice(wrap(ix + dx), wrap(iy + dy), seed) >> 8U) * 0x1p-24F;
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), sx), glm::mix(at(0, 1), at(1, 1), sx), sy);
}

float fractal_noise(float x, float y, int period, int octaves, std::uint32_t seed) {
    float sum = 0, weight = 0.5F, total = 0;
    for (int o = 0; o < octaves; ++o) {
        sum += weight * value_noise(x, y, period, seed + static_cast<std::uint32_t>(o));
        total += weight;
        weight *= 0.5F;
        x *= 2;
        y *= 2;
        period *= 2;
    }
    return sum / total;
}

Texture mottled_texture(std::string name, vec3 linear_rgb, float contrast, float streaks, std::uint32_t seed) {
    return paint(std::move(name), [=](float u, float v) {
        // Broad stains over fine grain, stains a little warmer than the ground colour.
        const int rows = std::max(1, static_cast<int>(std::lround(6 * (1 - streaks))));
        const float stain = fractal_noise(6 * u, static_cast<float>(rows) * v, 1 * 6, 4, seed) - 0.5F;
        const float grain = fractal_noise(48 * u, 48 * v, 48, 2, seed + 17) - 0.5F;
        const vec3 tint = glm::mix(vec3(1), vec3(1.08F, 1.0F, 0.88F), std::clamp(stain * 2, 0.0F, 1.0F));
        return vec4(linear_rgb * tint * (1 + contrast * (1.3F * stain + 0.7F * grain)), 1);
    });
}

Texture wood_texture(std::string name, vec3 linear_rgb, std::uint32_t seed) {
    return paint(std::move(name), [=](float u, float v) {
        const float grain = fractal_noise(32 * u, 2 * v, 32, 3, seed) - 0.5F;
        const float plank = value_noise(4 * u, v, 4, seed + 5) - 0.5F;
        return vec4(linear_rgb * (1 + 0.9F * grain + 0.3F * plank), 1);
    });
}

Texture water_texture(std::string name, vec3 linear_rgb, std::uint32_t seed) {
    return paint(std::move(name), [=](float u, float v) {
        // Crests bend with a slow swell; patches of wind roughen them.
        const float swell = fractal_noise(3 * u, 3 * v, 3, 3, seed) - 0.5F;
        const float crests = fractal_noise(8 * u + 2 * swell, 24 * v + 5 * swell, 8, 3, seed + 7) - 0.5F;
        const float wind = value_noise(2 * u, 2 * v, 2, seed + 11);
        const float light = 1 + 0.5F * swell + (0.8F + 1.2F * wind) * crests;
        return vec4(linear_rgb * std::max(light, 0.3F), 1);
    });
}

Texture twig_texture(std::string name, vec3 linear_rgb, std::uint32_t seed) {
    const std::vector<Leaf> leaves = twig_leaves(seed);
    Texture texture = paint(std::move(name), [&](float u, float v) {
        // The twig itself, then whichever leaf covers the point last. Where nothing is, leaf green keeps filtered
        // edges from darkening.
        const float texel = 1.0F / side;
        const float off_twig = std::abs(u - 0.5F - 0.03F * std::sin(9 * (1 - v)));
        float alpha = v > 0.14F ? std::clamp((0.008F - off_twig) / texel + 0.5F, 0.0F, 1.0F) : 0.0F;
        vec3 color = linear_rgb * 0.7F;
        for (const Leaf& leaf : leaves) {
            const float length = glm::length(leaf.axis);
            const vec2 along = leaf.axis / length;
            const vec2 d = vec2(u, v) - leaf.root;
            const float t = glm::dot(d, along) / length;
            const float s = std::abs(along.x * d.y - along.y * d.x);
            const float half =
                t > 0 && t < 1 ? 0.5F * leaf.width * length * std::pow(std::sin(pi * std::pow(t, 0.8F)), 0.8F) : 0.0F;
            const float cover = half > 0 ? std::clamp((half - s) / texel + 0.5F, 0.0F, 1.0F) : 0.0F;
            if (cover > 0) {
                const float vein = s < 0.006F ? 1.25F : 1.0F;
                color = linear_rgb * leaf.tint * vein * (0.85F + 0.3F * t);
                alpha = std::max(alpha, cover);
            }
        }
        return vec4(color, alpha);
    });
    texture.repeat_u = texture.repeat_v = false;
    return texture;
}

}  // namespace gn::scenes
