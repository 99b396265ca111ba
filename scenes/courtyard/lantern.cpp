// SPDX-License-Identifier: MIT
// A six-sided lantern on a wall bracket. The light is at its middle; the frame's bars cast the shadows.
#include "scenes/courtyard/courtyard.h"

namespace gn::scenes::yard {

void add_lantern(MeshBuilder& builder, const Materials& m) {
    const vec3 at = lantern_at;
    constexpr int sides = 6;
    constexpr float radius = 0.15F, low = -0.19F, high = 0.19F;
    const auto corner = [](int k, float r, float y) {
        const float a = 2 * pi * static_cast<float>(k) / sides;
        return vec3(r * std::sin(a), y, r * std::cos(a));
    };
    // Bars at the corners, a crossing rail half way, and a floor and a roof that keep the light off.
    builder.begin("lantern frame", m.iron);
    builder.place(at);
    for (int k = 0; k < sides; ++k) {
        builder.rod(corner(k, radius * 0.86F, low - 0.01F), corner(k, radius * 1.05F, high + 0.01F), 0.007F, 6);
        builder.rod(corner(k, radius * 0.96F, 0.02F), corner(k + 1, radius * 0.96F, 0.02F), 0.0045F, 5);
    }
    const std::array base{vec2(0.05F, low - 0.045F), vec2(0.14F, low - 0.02F), vec2(0.14F, low),
                          vec2(0.13F, low + 0.004F)};
    builder.lathe(base, sides);
    builder.begin("lantern roof", m.brass);
    builder.place(at);
    const std::array roof{vec2(0.20F, high),           vec2(0.205F, high + 0.012F), vec2(0.09F, high + 0.10F),
                          vec2(0.055F, high + 0.105F), vec2(0.05F, high + 0.14F),   vec2(0.012F, high + 0.165F),
                          vec2(0.012F, high + 0.22F)};
    builder.lathe(roof, sides);
    // The bracket: an arm from the wall, a brace below it, and the ring that the lantern hangs from.
    builder.begin("lantern bracket", m.iron);
    const float arm = high + 0.245F, wall = north - gallery_depth - at.z;
    builder.place(at);
    builder.rod({0, arm, wall - 0.02F}, {0, arm, 0.06F}, 0.013F, 8);
    builder.tube(std::array{vec3(0, arm - 0.34F, wall - 0.02F), vec3(0, arm - 0.24F, wall + 0.12F),
                            vec3(0, arm - 0.08F, wall + 0.24F), vec3(0, arm, wall + 0.40F)},
                 std::array{0.011F, 0.011F, 0.011F, 0.011F}, 7);
    builder.box({-0.05F, arm - 0.40F, wall - 0.02F}, {0.05F, arm + 0.06F, wall + 0.012F});
    builder.place(glm::rotate(glm::translate(mat4(1), at + vec3(0, high + 0.225F, 0)), pi / 2, vec3(1, 0, 0)));
    builder.ring(0.028F, 0, 0.006F, 14, 6);
    // A candle stub under the flame, well below the lit part of the panes.
    builder.begin("lantern candle", m.plaster);
    builder.place(at);
    builder.rod({0, low - 0.005F, 0}, {0, low + 0.06F, 0}, 0.028F, 10);
}

}  // namespace gn::scenes::yard
