// SPDX-License-Identifier: MIT
// The east side: a low wall with stone piers and an iron fence on it, and a gate whose leaf stands open.
#include "scenes/courtyard/courtyard.h"

namespace gn::scenes::yard {
namespace {

constexpr float line = east + 0.2F;  // x of the fence
constexpr float wall_top = 0.42F, bar_top = 1.95F;
constexpr std::array<float, 5> piers{-5.35F, -3.9F, -1.6F, 3.85F, 9.3F};  // z; the gate is between the second and third

// Bars with a spear on each, two rails and a ring between each two bars, along x from 0 to `length` at z = 0.
void add_panel(MeshBuilder& builder, float length, float low, float high) {
    const int bars = static_cast<int>(length / 0.125F);
    const float step = length / static_cast<float>(bars);
    for (const float y : {low + 0.10F, high - 0.24F, high - 0.10F}) {
        builder.box({0, y - 0.012F, -0.016F}, {length, y + 0.012F, 0.016F});
    }
    const mat4 panel = builder.placement();
    for (int i = 0; i < bars; ++i) {
        const float x = (static_cast<float>(i) + 0.5F) * step;
        builder.place(glm::translate(panel, vec3(x, 0, 0)));
        const std::array<vec2, 8> profile{vec2(0.009F, low),           vec2(0.009F, high),
                                          vec2(0.018F, high + 0.01F),  vec2(0.009F, high + 0.025F),
                                          vec2(0.009F, high + 0.035F), vec2(0.024F, high + 0.075F),
                                          vec2(0.011F, high + 0.125F), vec2(0, high + 0.17F)};
        builder.lathe(profile, 6);
        if (i + 1 < bars && i % 2 == 0) {
            builder.place(
                glm::rotate(glm::translate(panel, vec3(x + 0.5F * step, high - 0.17F, 0)), pi / 2, vec3(1, 0, 0)));
            builder.ring(0.048F, 0, 0.007F, 12, 5);
        }
    }
    builder.place(panel);
}

void add_pier(MeshBuilder& builder, float z) {
    builder.place(vec3(line, 0, z));
    builder.chamfered_slab({-0.24F, -0.15F, -0.24F}, {0.24F, 2.1F, 0.24F}, 0.02F);
    builder.chamfered_slab({-0.31F, 2.09F, -0.31F}, {0.31F, 2.22F, 0.31F}, 0.04F);
    const std::array<vec2, 9> ball{vec2(0.09F, 2.06F), vec2(0.07F, 2.12F),  vec2(0.13F, 2.16F),
                                   vec2(0.17F, 2.23F), vec2(0.18F, 2.30F),  vec2(0.16F, 2.38F),
                                   vec2(0.11F, 2.45F), vec2(0.05F, 2.485F), vec2(0, 2.49F)};
    builder.place(vec3(line, 0.15F, z));
    builder.lathe(ball, 14);
}

}  // namespace

void add_fence(MeshBuilder& builder, const Materials& m) {
    builder.begin("fence piers", m.stone, 0.8F);
    for (const float z : piers) {
        add_pier(builder, z);
    }
    // Low walls and panels between piers, but for the gateway.
    for (std::size_t i = 0; i + 1 < piers.size(); ++i) {
        const float from = piers[i] + 0.2F, to = piers[i + 1] - 0.2F;
        const bool gateway = i == 1;
        if (!gateway) {
            builder.begin(fmt::format("low wall {}", i), m.stone, 0.6F);
            builder.chamfered_slab({line - 0.17F, -0.15F, from - 0.1F}, {line + 0.17F, wall_top, to + 0.1F}, 0.02F);
            builder.begin(fmt::format("fence panel {}", i), m.iron);
            builder.place(vec3(line, 0, to), pi / 2);
            add_panel(builder, to - from, wall_top - 0.02F, bar_top);
        }
    }
    // The gate's leaf is hinged at the northern pier and stands open into the court.
    builder.begin("gate", m.iron);
    builder.place(vec3(line - 0.26F, 0, piers[1] + 0.2F), pi - 0.55F);
    add_panel(builder, 1.5F, 0.08F, 1.62F);
    builder.box({-0.02F, 0.06F, -0.02F}, {0.02F, 1.72F, 0.02F});
    builder.box({1.48F, 0.06F, -0.02F}, {1.52F, 1.72F, 0.02F});
    // A threshold in the gateway.
    builder.begin("threshold", m.stone, 0.8F);
    builder.chamfered_slab({east - 0.04F, -0.12F, piers[1] + 0.2F}, {east + 0.6F, 0.015F, piers[2] - 0.2F}, 0.01F);
}

}  // namespace gn::scenes::yard
