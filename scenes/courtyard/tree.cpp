// SPDX-License-Identifier: MIT
// An olive-like tree: tapered trunk and boughs, and twigs of leaves on alpha-masked cards.
#include "scenes/courtyard/courtyard.h"

#include "scenes/noise.h"

namespace gn::scenes::yard {
namespace {

constexpr float trunk_height = 1.75F;

// One bough: a tube that bends from `from` along `direction` and thins to a third.
std::vector<vec3> add_bough(MeshBuilder& builder, Dice& dice, vec3 from, vec3 direction, float length, float radius,
                            int sides) {
    constexpr int joints = 5;
    std::vector<vec3> path{from};
    std::vector<float> radii{radius};
    vec3 heading = glm::normalize(direction);
    for (int i = 1; i <= joints; ++i) {
        heading = glm::normalize(
            heading + vec3(dice.between(-0.22F, 0.22F), dice.between(-0.05F, 0.25F), dice.between(-0.22F, 0.22F)));
        path.push_back(path.back() + heading * (length / joints));
        radii.push_back(radius * glm::mix(1.0F, 0.33F, static_cast<float>(i) / joints));
    }
    builder.tube(path, radii, sides);
    return path;
}

// A card that holds a twig: its root at `root`, the twig pointing along `along`.
void add_card(MeshBuilder& builder, Dice& dice, vec3 root, vec3 along, vec3 crown) {
    const float size = dice.between(0.34F, 0.48F);
    vec3 x, y;
    complete_frame(along, x, y);
    const float turn = dice.between(0, 2 * pi);
    const vec3 side = std::cos(turn) * x + std::sin(turn) * y;
    const vec3 corner = root - 0.5F * size * side;
    const vec3 flat = glm::normalize(glm::cross(side, along));
    // Shading normals lean outwards from the crown, so that the foliage reads as one soft volume.
    std::array<std::uint32_t, 4> ids{};
    for (std::size_t k = 0; k < 4; ++k) {
        const float u = k == 1 || k == 2 ? 1.0F : 0.0F, v = k >= 2 ? 1.0F : 0.0F;
        const vec3 p = corner + u * size * side + v * size * along;
        const vec3 outwards = glm::normalize(p - crown);
        const vec3 n = glm::normalize(outwards * 0.6F + (glm::dot(flat, outwards) < 0 ? -flat : flat) * 0.8F);
        ids[k] = builder.vertex(p, n, {u, 1 - v});
    }
    // Wind the card so that its front agrees with the shading normals.
    if (glm::dot(flat, root + 0.5F * size * along - crown) < 0) {
        std::swap(ids[1], ids[3]);
    }
    builder.triangle(ids[0], ids[1], ids[2]);
    builder.triangle(ids[0], ids[2], ids[3]);
}

void add_one_tree(MeshBuilder& builder, const Materials& m, vec3 foot, std::uint32_t seed) {
    Dice dice(seed);
    // Trunk, with its flare at the ground.
    builder.begin("trunk", m.bark);
    const std::array path{foot + vec3(0, -0.12F, 0), foot + vec3(0.01F, 0.12F, 0), foot + vec3(0.05F, 0.55F, 0.03F),
                          foot + vec3(0.02F, 1.15F, 0.09F), foot + vec3(-0.06F, 1.75F, 0.06F)};
    builder.tube(path, std::array{0.24F, 0.165F, 0.125F, 0.115F, 0.095F}, 12);

    // Boughs from the fork, twice branched; twigs sprout from the outer ones.
    builder.begin("boughs", m.bark);
    const vec3 fork = path.back() - vec3(0, 0.06F, 0), crown = foot + vec3(0, trunk_height + 1.05F, 0);
    struct Sprout {
        vec3 at, along;
    };
    std::vector<Sprout> sprouts;
    const auto sprout_along = [&](const std::vector<vec3>& bough, std::size_t from) {
        for (std::size_t i = from; i < bough.size(); ++i) {
            sprouts.push_back({bough[i], glm::normalize(bough[i] - bough[i - 1])});
        }
    };
    constexpr int boughs = 8;
    for (int b = 0; b < boughs; ++b) {
        const float a = 2 * pi * (static_cast<float>(b) + dice.between(-0.2F, 0.2F)) / boughs;
        const vec3 heading(std::cos(a), dice.between(0.85F, 1.6F), std::sin(a));
        const auto bough = add_bough(builder, dice, fork, heading, dice.between(1.25F, 1.7F), 0.062F, 7);
        sprout_along(bough, 4);
        for (int t = 0; t < 5; ++t) {
            const auto at = static_cast<std::size_t>(2 + t % 4);
            const vec3 spread(dice.between(-1, 1), dice.between(-0.25F, 0.9F), dice.between(-1, 1));
            const auto twig =
                add_bough(builder, dice, bough[at], heading * 0.5F + spread, dice.between(0.55F, 0.95F), 0.022F, 5);
            sprout_along(twig, 1);
        }
    }

    // Cards around every sprout; a few hundred leaves hang from each bough.
    builder.begin("leaves (sheet)", m.leaves);
    for (const Sprout& s : sprouts) {
        for (int c = 0; c < 7; ++c) {
            const vec3 loose(dice.between(-1, 1), dice.between(-0.7F, 1), dice.between(-1, 1));
            const vec3 near = s.at + 0.16F * vec3(dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1));
            add_card(builder, dice, near, glm::normalize(0.5F * s.along + loose), crown);
        }
    }

    // A ring of kerb stones around the trunk, with earth inside.
    builder.begin("tree kerb", m.stone, 0.8F);
    builder.place(vec3(foot.x, 0, foot.z));
    const std::array kerb{vec2(0.72F, -0.1F), vec2(0.72F, 0.13F), vec2(0.70F, 0.15F),
                          vec2(0.56F, 0.15F), vec2(0.54F, 0.13F), vec2(0.54F, 0.06F)};
    builder.lathe(kerb, 24);
}

}  // namespace

void add_tree(MeshBuilder& builder, const Materials& m) {
    // The second one stands beside the main view and only throws its shadow into it.
    add_one_tree(builder, m, {3.6F, -0.02F, 1.3F}, 59);
    add_one_tree(builder, m, {5.1F, -0.02F, 6.1F}, 53);
}

}  // namespace gn::scenes::yard
