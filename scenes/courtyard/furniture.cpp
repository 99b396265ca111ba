// SPDX-License-Identifier: MIT
// Table, chairs and pots. Feet reach a millimetre into the pavement's highest level, so that shadows attach.
#include "scenes/courtyard/courtyard.h"

#include "scenes/noise.h"

namespace gn::scenes::yard {
namespace {

constexpr float sink = -0.007F;  // the lowest stones lie 6 mm down

void add_table(MeshBuilder& builder, const Materials& m, vec3 at) {
    builder.begin("table top", m.wood, 0.9F);
    builder.place(at);
    const std::array top{vec2(0.56F, 0.715F), vec2(0.58F, 0.725F), vec2(0.58F, 0.745F), vec2(0.57F, 0.752F)};
    builder.lathe(top, 32);
    // Three bent iron legs that meet under the top, and a ring that ties them.
    builder.begin("table legs", m.iron);
    for (int k = 0; k < 3; ++k) {
        builder.place(at, 2 * pi * static_cast<float>(k) / 3);
        const std::array path{vec3(0.46F, sink, 0),  vec3(0.36F, 0.10F, 0), vec3(0.17F, 0.30F, 0),
                              vec3(0.14F, 0.45F, 0), vec3(0.24F, 0.62F, 0), vec3(0.42F, 0.72F, 0)};
        builder.tube(path, std::vector<float>(path.size(), 0.012F), 7);
    }
    builder.place(at);
    builder.ring(0.155F, 0.36F, 0.008F, 24, 6);
    builder.ring(0.50F, 0.708F, 0.009F, 32, 6);
    // A jug and two cups.
    builder.begin("jug", m.terracotta);
    builder.place(at + vec3(-0.12F, 0.751F, -0.08F));
    const std::array jug{vec2(0.05F, 0),      vec2(0.085F, 0.05F), vec2(0.09F, 0.11F),
                         vec2(0.06F, 0.17F),  vec2(0.045F, 0.21F), vec2(0.058F, 0.245F),
                         vec2(0.05F, 0.245F), vec2(0.036F, 0.21F), vec2(0.03F, 0.16F)};
    builder.lathe(jug, 16);
    for (const vec2 cup : {vec2(0.16F, 0.12F), vec2(0.05F, 0.27F)}) {
        builder.place(at + vec3(cup.x, 0.751F, cup.y));
        const std::array profile{vec2(0.028F, 0), vec2(0.038F, 0.075F), vec2(0.032F, 0.075F), vec2(0.024F, 0.012F)};
        builder.lathe(profile, 12);
    }
}

void add_chair(MeshBuilder& builder, const Materials& m, vec3 at, float yaw) {
    builder.begin("chair frame", m.iron);
    builder.place(at, yaw);
    // The sitter faces +z: front legs, then back legs that lean and carry the back.
    for (const float side : {-1.0F, 1.0F}) {
        builder.tube(std::array{vec3(side * 0.20F, sink, 0.20F), vec3(side * 0.185F, 0.44F, 0.18F)},
                     std::array{0.010F, 0.012F}, 7);
        const std::array back{vec3(side * 0.20F, sink, -0.22F), vec3(side * 0.185F, 0.44F, -0.17F),
                              vec3(side * 0.18F, 0.66F, -0.21F), vec3(side * 0.15F, 0.86F, -0.27F),
                              vec3(side * 0.05F, 0.93F, -0.29F)};
        builder.tube(back, std::vector<float>(back.size(), 0.012F), 7);
        builder.rod({side * 0.19F, 0.20F, 0.19F}, {side * 0.193F, 0.20F, -0.196F}, 0.007F, 6);
        builder.tube(std::array{vec3(side * 0.10F, 0.44F, -0.17F), vec3(side * 0.09F, 0.66F, -0.21F),
                                vec3(side * 0.06F, 0.925F, -0.288F)},
                     std::array{0.007F, 0.007F, 0.007F}, 6);
    }
    builder.rod({-0.06F, 0.929F, -0.2895F}, {0.06F, 0.929F, -0.2895F}, 0.012F, 7);
    builder.rod({-0.182F, 0.62F, -0.203F}, {0.182F, 0.62F, -0.203F}, 0.007F, 6);
    builder.place(glm::translate(builder.placement(), vec3(0, 0.432F, 0)));
    builder.rod({-0.19F, 0, 0.18F}, {0.19F, 0, 0.18F}, 0.009F, 6);
    builder.rod({-0.19F, 0, -0.17F}, {0.19F, 0, -0.17F}, 0.009F, 6);
    // Slats with gaps.
    builder.begin("chair seat", m.wood, 1.5F);
    builder.place(at, yaw);
    for (int i = 0; i < 6; ++i) {
        const float z = -0.185F + 0.067F * static_cast<float>(i);
        builder.chamfered_slab({-0.215F, 0.438F, z}, {0.215F, 0.458F, z + 0.052F}, 0.004F);
    }
}

// A pot with a rim and earth, and a small bush of masked twigs in it.
void add_pot(MeshBuilder& builder, const Materials& m, vec3 at, float scale, std::uint32_t seed) {
    builder.begin("pot", m.terracotta);
    builder.place(glm::scale(glm::translate(mat4(1), at), vec3(scale)));
    const std::array profile{vec2(0.16F, sink),  vec2(0.24F, 0.30F), vec2(0.27F, 0.31F),
                             vec2(0.27F, 0.37F), vec2(0.23F, 0.37F), vec2(0.22F, 0.32F)};
    builder.lathe(profile, 20);
    builder.begin("pot plant (sheet)", m.leaves);
    Dice dice(seed);
    for (int i = 0; i < 46; ++i) {
        const float a = dice.between(0, 2 * pi), lean = dice.between(0.1F, 0.9F),
                    size = scale * dice.between(0.38F, 0.55F);
        const vec3 along = glm::normalize(vec3(lean * std::cos(a), 1, lean * std::sin(a)));
        const vec3 side = glm::normalize(glm::cross(along, vec3(std::cos(a + lean * 5), 0.2F, std::sin(a + lean * 5))));
        const vec3 root = at + scale * vec3(0.1F * std::cos(a), 0.30F + 0.25F * dice.unit(), 0.1F * std::sin(a));
        builder.sheet(root - 0.5F * size * side, size * side, size * along, true);
    }
}

}  // namespace

void add_furniture(MeshBuilder& builder, const Materials& m) {
    const vec3 table(-2.75F, 0, 3.1F);
    add_table(builder, m, table);
    add_chair(builder, m, table + vec3(0.78F, 0, 0.42F), -2.0F);
    add_chair(builder, m, table + vec3(-0.25F, 0, -0.88F), 0.25F);
    add_chair(builder, m, table + vec3(-0.92F, 0, 0.35F), 1.9F);
    // Pots beside the steps, by the arcade and at the gate.
    const float middle = west + 2.5F * bay;
    add_pot(builder, m, {middle - 2.15F, 0, north + 0.95F}, 1.25F, 101);
    add_pot(builder, m, {middle + 2.15F, 0, north + 0.95F}, 1.25F, 103);
    add_pot(builder, m, {west + 0.95F, 0, -1.6F}, 1.0F, 107);
    add_pot(builder, m, {west + 1.0F, 0, -0.9F}, 0.7F, 109);
    add_pot(builder, m, {east - 0.55F, 0, 4.9F}, 1.1F, 113);
}

}  // namespace gn::scenes::yard
