// SPDX-License-Identifier: MIT
// The podium, its steps, two arcades with columns and round arches, and the lean-to roofs over their galleries.
#include "scenes/courtyard/courtyard.h"

namespace gn::scenes::yard {
namespace {

constexpr int north_bays = 5, west_bays = 6;
constexpr float wall_depth = 0.40F;

void add_column(MeshBuilder& builder, vec3 foot) {
    builder.place(foot);
    // Plinth and abacus are square; base, shaft with its slight swelling and capital are turned.
    builder.box({-0.21F, -0.002F, -0.21F}, {0.21F, 0.12F, 0.21F});
    const std::array profile{vec2(0.195F, 0.119F), vec2(0.205F, 0.15F),  vec2(0.19F, 0.18F),   vec2(0.165F, 0.20F),
                             vec2(0.175F, 0.225F), vec2(0.15F, 0.25F),   vec2(0.152F, 0.80F),  vec2(0.145F, 1.40F),
                             vec2(0.13F, 1.84F),   vec2(0.145F, 1.855F), vec2(0.145F, 1.885F), vec2(0.13F, 1.90F),
                             vec2(0.145F, 1.97F),  vec2(0.20F, 2.08F),   vec2(0.215F, 2.101F)};
    builder.lathe(profile, 20);
    builder.box({-0.23F, 2.10F, -0.23F}, {0.23F, spring_height - gallery_floor + 0.02F, 0.23F});
}

// The underside of a wall over `bays` arches, from the middle of one support to the middle of the last.
std::vector<vec2> arch_line(int bays) {
    std::vector<vec2> line{{0, spring_height}};
    constexpr int segments = 20;
    for (int k = 0; k < bays; ++k) {
        const float middle = (static_cast<float>(k) + 0.5F) * bay;
        for (int i = 0; i <= segments; ++i) {
            const float a = pi * static_cast<float>(i) / segments;
            const float lift = i == 0 || i == segments ? 0.0F : std::sin(a);
            line.emplace_back(middle - arch_radius * std::cos(a), spring_height + arch_radius * lift);
        }
    }
    line.emplace_back(static_cast<float>(bays) * bay, spring_height);
    return line;
}

// A roll moulding round every arch, half sunk into the wall's face.
void add_mouldings(MeshBuilder& builder, int bays) {
    constexpr int segments = 20;
    for (int k = 0; k < bays; ++k) {
        std::vector<vec3> path;
        for (int i = 0; i <= segments; ++i) {
            const float a = pi * static_cast<float>(i) / segments;
            path.emplace_back((static_cast<float>(k) + 0.5F) * bay - (arch_radius + 0.07F) * std::cos(a),
                              spring_height + (arch_radius + 0.07F) * std::sin(a), wall_depth);
        }
        builder.tube(path, std::vector<float>(path.size(), 0.045F), 6);
    }
}

// Rows of half-round tiles down the slope from the back wall to the eaves, over a boarded deck.
void add_roof(MeshBuilder& builder, const Materials& m, const mat4& ws_from_os, float length, std::string_view name) {
    const float rise = 1.15F, reach = gallery_depth + 0.75F;
    const float slope = std::atan2(rise, reach), run = std::hypot(rise, reach);
    // In the deck's frame x runs along the arcade, y up through the tiles, z down the slope from the back wall.
    const mat4 deck = ws_from_os * glm::rotate(glm::translate(mat4(1), vec3(0, eaves + 0.22F + rise, -gallery_depth)),
                                               slope, vec3(1, 0, 0));
    builder.begin(fmt::format("{} roof deck", name), m.wood);
    builder.place(deck);
    builder.box({0, -0.10F, 0}, {length, 0, run});
    builder.begin(fmt::format("{} roof tiles", name), m.tile, 0.6F);
    builder.place(deck);
    const std::array<vec2, 6> half_round{vec2(0.105F, -0.02F), vec2(0.09F, 0.045F),  vec2(0.04F, 0.082F),
                                         vec2(-0.04F, 0.082F), vec2(-0.09F, 0.045F), vec2(-0.105F, -0.02F)};
    const int rows = static_cast<int>(length / 0.235F);
    const int courses = 3;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < courses; ++c) {
            const float x = (static_cast<float>(r) + 0.5F) * length / static_cast<float>(rows);
            const float z = run * static_cast<float>(c) / courses;
            // Each course lies a little higher at its lower end, over the next one.
            const float tilt = 0.022F;
            builder.place(deck * glm::rotate(glm::translate(mat4(1), vec3(x, 0.012F, z)), -tilt, vec3(1, 0, 0)));
            builder.prism(half_round, run / courses + 0.06F);
        }
    }
    builder.begin(fmt::format("{} rafters", name), m.wood);
    builder.place(deck);
    for (float x = 0.35F; x < length - 0.2F; x += bay / 4) {
        builder.box({x - 0.045F, -0.22F, 0.02F}, {x + 0.045F, -0.099F, run - 0.05F});
    }
}

// One arcade in its own frame: x along the supports from the corner pier, z towards the court.
void add_arcade(MeshBuilder& builder, const Materials& m, const mat4& ws_from_os, int bays, bool pier_first,
                std::string_view name) {
    const float length = static_cast<float>(bays) * bay;
    builder.begin(fmt::format("{} columns", name), m.stone, 0.8F);
    for (int k = 1; k < bays; ++k) {
        add_column(builder, vec3(ws_from_os * vec4(static_cast<float>(k) * bay, gallery_floor, 0, 1)));
    }
    builder.begin(fmt::format("{} arches", name), m.plaster, 0.4F);
    builder.place(ws_from_os * glm::translate(mat4(1), vec3(0, 0, -0.5F * wall_depth)));
    builder.wall_over(arch_line(bays), eaves, wall_depth);
    builder.begin(fmt::format("{} mouldings", name), m.stone, 0.8F);
    builder.place(ws_from_os * glm::translate(mat4(1), vec3(0, 0, -0.5F * wall_depth)));
    add_mouldings(builder, bays);
    builder.box({-0.05F, eaves - 0.02F, -0.02F}, {length + 0.05F, eaves + 0.07F, wall_depth + 0.06F});
    builder.box({-0.07F, eaves + 0.069F, -0.04F}, {length + 0.07F, eaves + 0.15F, wall_depth + 0.13F});
    // The support at the open end is a square pier; the corner's pier belongs to both arcades.
    builder.begin(fmt::format("{} end pier", name), m.stone, 0.8F);
    builder.place(ws_from_os * glm::translate(mat4(1), vec3(pier_first ? 0 : length, 0, 0)));
    builder.chamfered_slab({-0.27F, gallery_floor - 0.002F, -0.27F}, {0.27F, eaves + 0.20F, 0.27F}, 0.02F);
    builder.box({-0.31F, gallery_floor - 0.003F, -0.31F}, {0.31F, gallery_floor + 0.16F, 0.31F});
    // The roof starts or ends above the corner of the outer walls.
    const float over = gallery_depth + 0.3F;
    add_roof(builder, m, ws_from_os * glm::translate(mat4(1), vec3(pier_first ? -0.35F : -over, 0, 0)),
             length + over + 0.35F, name);
}

void add_podium(MeshBuilder& builder, const Materials& m) {
    builder.begin("podium", m.stone, 0.5F);
    builder.chamfered_slab({-9.3F, -0.2F, -9.3F}, {east + 0.45F, gallery_floor, north + 0.42F}, 0.025F);
    builder.chamfered_slab({-9.3F, -0.2F, north + 0.42F}, {west + 0.42F, gallery_floor, south + 0.3F}, 0.025F);
    // Two steps up to the third bay of the north arcade, the third riser is the podium's own.
    builder.begin("steps", m.stone, 0.7F);
    const float middle = west + 2.5F * bay;
    builder.chamfered_slab({middle - 1.75F, -0.1F, north + 0.40F}, {middle + 1.75F, 0.15F, north + 1.12F}, 0.02F);
    builder.chamfered_slab({middle - 1.40F, 0.05F, north + 0.41F}, {middle + 1.40F, 0.30F, north + 0.78F}, 0.02F);
}

}  // namespace

void add_arcades(MeshBuilder& builder, const Materials& m) {
    add_podium(builder, m);
    // The north arcade runs east from the corner; the west one runs north towards it.
    add_arcade(builder, m, glm::translate(mat4(1), vec3(west, 0, north)), north_bays, false, "north");
    const mat4 west_frame = glm::rotate(glm::translate(mat4(1), vec3(west, 0, south)), pi / 2, vec3(0, 1, 0));
    add_arcade(builder, m, west_frame, west_bays, true, "west");
    builder.begin("corner pier", m.stone, 0.8F);
    builder.chamfered_slab({west - 0.28F, gallery_floor - 0.002F, north - 0.28F},
                           {west + 0.28F, eaves + 0.21F, north + 0.28F}, 0.02F);
}

}  // namespace gn::scenes::yard
