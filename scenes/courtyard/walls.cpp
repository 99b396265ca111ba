// SPDX-License-Identifier: MIT
// The outer walls behind the galleries, with the grilled window that hides the spot, a door, and upper windows.
#include "scenes/courtyard/courtyard.h"

namespace gn::scenes::yard {
namespace {

constexpr float back = north - gallery_depth, top = 6.9F, right = east + 0.6F, thickness = 0.4F;

// Every window below has the same opening, in a frame with its origin at the middle of the sill on the wall's face, x
// along the wall and z out of it.
constexpr vec3 low{-0.55F, 0, -thickness}, high{0.55F, 1.5F, 0};

// The chamber behind a window: five thick walls that let light in and out through the opening only.
void add_chamber(MeshBuilder& builder, const Materials& m, const mat4& ws_from_os) {
    builder.begin("chamber", m.dark);
    builder.place(ws_from_os);
    const vec3 a(low.x - 0.25F, -0.65F, -2.4F), b(high.x + 0.25F, high.y + 0.35F, -thickness + 0.05F);
    builder.box({a.x - 0.2F, a.y - 0.2F, a.z}, {a.x, b.y + 0.2F, b.z});
    builder.box({b.x, a.y - 0.2F, a.z}, {b.x + 0.2F, b.y + 0.2F, b.z});
    builder.box({a.x - 0.01F, a.y - 0.19F, a.z}, {b.x + 0.01F, a.y, b.z});
    builder.box({a.x - 0.01F, b.y, a.z}, {b.x + 0.01F, b.y + 0.19F, b.z});
    builder.box({a.x - 0.21F, a.y - 0.21F, a.z - 0.2F}, {b.x + 0.21F, b.y + 0.21F, a.z + 0.01F});
}

// Upright and level bars with a small boss at every crossing.
void add_grille(MeshBuilder& builder, const Materials& m, const mat4& ws_from_os) {
    builder.begin("grille", m.iron);
    builder.place(ws_from_os);
    const float z = -0.5F * thickness;
    const int uprights = 6, rails = 5;
    for (int i = 1; i <= uprights; ++i) {
        const float x = glm::mix(low.x, high.x, static_cast<float>(i) / (uprights + 1));
        builder.rod({x, low.y - 0.05F, z}, {x, high.y + 0.05F, z}, 0.013F, 8);
        for (int k = 1; k <= rails; ++k) {
            builder.sphere({x, glm::mix(low.y, high.y, static_cast<float>(k) / (rails + 1)), z}, 0.028F, 6);
        }
    }
    for (int k = 1; k <= rails; ++k) {
        const float y = glm::mix(low.y, high.y, static_cast<float>(k) / (rails + 1));
        builder.box({low.x - 0.05F, y - 0.013F, z - 0.007F}, {high.x + 0.05F, y + 0.013F, z + 0.007F});
    }
}

void add_window(MeshBuilder& builder, const Materials& m, const mat4& ws_from_os) {
    builder.begin("window frame", m.stone, 0.8F);
    builder.place(ws_from_os);
    builder.box({low.x - 0.14F, low.y - 0.10F, -0.1F}, {high.x + 0.14F, low.y, 0.07F});
    builder.box({low.x - 0.12F, high.y, -0.1F}, {high.x + 0.12F, high.y + 0.14F, 0.04F});
    builder.box({low.x - 0.11F, low.y - 0.01F, -0.1F}, {low.x, high.y + 0.01F, 0.035F});
    builder.box({high.x, low.y - 0.01F, -0.1F}, {high.x + 0.11F, high.y + 0.01F, 0.035F});
    add_grille(builder, m, ws_from_os);
    add_chamber(builder, m, ws_from_os);
}

// A wall from the frame's origin along x, pierced by one window whose middle is at `window_x`.
void add_pierced_wall(MeshBuilder& builder, const Materials& m, const mat4& ws_from_os, float length, float window_x,
                      std::string_view name) {
    builder.begin(fmt::format("{} wall", name), m.plaster, 0.4F);
    builder.place(ws_from_os);
    const float left = window_x + low.x, rest = window_x + high.x;
    builder.box({0, -0.2F, -thickness}, {left, top, 0});
    builder.box({rest, -0.2F, -thickness}, {length, top, 0});
    builder.box({left, -0.2F, -thickness}, {rest, window_sill + low.y, 0});
    builder.box({left, window_sill + high.y, -thickness}, {rest, top, 0});
    add_window(builder, m, ws_from_os * glm::translate(mat4(1), vec3(window_x, window_sill, 0)));
}

// A plank door under a round arch, in the wall behind the steps.
void add_door(MeshBuilder& builder, const Materials& m) {
    const float middle = west + 2.5F * bay;
    builder.begin("door", m.wood);
    for (int i = -3; i < 3; ++i) {
        const float x = middle + 0.19F * static_cast<float>(i);
        const float h =
            gallery_floor + 1.95F + std::sqrt(std::max(0.0F, 0.36F - std::pow(x + 0.095F - middle, 2.0F))) * 0.9F;
        builder.box({x + 0.004F, gallery_floor - 0.001F, back - 0.05F}, {x + 0.186F, h, back + 0.05F});
    }
    builder.begin("door iron", m.iron);
    for (const float y : {0.35F, 1.65F}) {
        builder.box({middle - 0.56F, gallery_floor + y, back + 0.045F},
                    {middle + 0.50F, gallery_floor + y + 0.06F, back + 0.062F});
    }
    builder.place(glm::rotate(glm::translate(mat4(1), vec3(middle + 0.42F, gallery_floor + 1.05F, back + 0.085F)),
                              pi / 2, vec3(1, 0, 0)));
    builder.ring(0.06F, 0, 0.011F, 14, 6);
    builder.begin("door frame", m.stone, 0.8F);
    std::vector<vec3> path{{middle - 0.66F, gallery_floor - 0.02F, back}};
    for (int i = 0; i <= 14; ++i) {
        const float a = pi * static_cast<float>(i) / 14;
        path.emplace_back(middle - 0.66F * std::cos(a), gallery_floor + 1.95F + 0.66F * std::sin(a), back);
    }
    path.emplace_back(middle + 0.66F, gallery_floor - 0.02F, back);
    builder.tube(path, std::vector<float>(path.size(), 0.10F), 8);
}

// Upper windows: stone frame, dark pane, open shutters that stand off the wall.
void add_upper_window(MeshBuilder& builder, const Materials& m, float x, float y) {
    builder.begin("upper window pane", m.dark);
    builder.box({x - 0.36F, y, back - 0.2F}, {x + 0.36F, y + 0.95F, back + 0.012F});
    builder.begin("upper window frame", m.stone);
    builder.box({x - 0.50F, y - 0.09F, back - 0.1F}, {x + 0.50F, y + 0.001F, back + 0.10F});
    builder.box({x - 0.46F, y + 0.949F, back - 0.1F}, {x + 0.46F, y + 1.07F, back + 0.06F});
    builder.begin("shutters", m.wood);
    for (const float side : {-1.0F, 1.0F}) {
        builder.place(vec3(x + side * 0.37F, y, back + 0.03F), side > 0 ? -0.35F : pi + 0.35F);
        builder.box({0.02F, 0, -0.015F}, {0.40F, 0.95F, 0.015F});
    }
}

}  // namespace

void add_walls(MeshBuilder& builder, const Materials& m) {
    // The north wall has a dark window; behind the west wall's, near the corner, hangs the spot.
    const float start = south + 0.6F, north_window = 3.1F;
    add_pierced_wall(builder, m, glm::translate(mat4(1), vec3(-9.4F, 0, back)), right + 9.4F, north_window + 9.4F,
                     "north");
    add_pierced_wall(builder, m, glm::rotate(glm::translate(mat4(1), vec3(-9.0F, 0, start)), pi / 2, vec3(0, 1, 0)),
                     start - back, start - spot_window_z, "west");
    add_door(builder, m);
    for (const float x : {-5.2F, -2.1F, 1.0F, 4.1F}) {
        add_upper_window(builder, m, x, 5.62F);
    }
    // A cornice ends the wall.
    builder.begin("wall cornice", m.stone, 0.6F);
    builder.box({-9.5F, top - 0.01F, back - thickness - 0.1F}, {right + 0.1F, top + 0.14F, back + 0.16F});
}

}  // namespace gn::scenes::yard
