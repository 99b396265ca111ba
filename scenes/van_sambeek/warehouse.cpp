// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// The two scenes "warehouse" of section 4.1.2: the same hall from inside, under one near area light, and from outside,
// with camera and light far away and close together.
#include "scenes/mesh_builder.h"
#include "scenes/noise.h"
#include "scenes/registry.h"
#include "scenes/van_sambeek/lights.h"

namespace gn::scenes {
namespace {

struct GnWarehouseParams {
    int light = as_rectangle;
    float size = 1.2F;
};

constexpr float half_x = 9, half_z = 14, eave = 6, ridge = 8, wall = 0.25F;
constexpr float door_half = 2.2F, door_height = 4.2F;

void add_shell(MeshBuilder& builder, int brick, int tin, int floor) {
    builder.begin("slab", floor);
    builder.box({-half_x - 0.4F, -0.4F, -half_z - 0.4F}, {half_x + 0.4F, 0, half_z + 0.4F});
    // Long walls carry a band of windows between piers; the gables are pierced by a door.
    builder.begin("walls", brick);
    for (const float side : {-1.0F, 1.0F}) {
        const auto wall_box = [&](float y0, float y1, float z0, float z1) {
            builder.box({side > 0 ? half_x : -half_x - wall, y0, z0}, {side > 0 ? half_x + wall : -half_x, y1, z1});
        };
        wall_box(-0.1F, 3.4F, -half_z, half_z);
        wall_box(5.0F, eave, -half_z, half_z);
        for (int i = 0; i <= 7; ++i) {
            const float z = -half_z + 2 * half_z * static_cast<float>(i) / 7;
            wall_box(3.4F, 5.0F, std::max(z - 0.6F, -half_z), std::min(z + 0.6F, half_z));
        }
        const float z0 = side > 0 ? half_z : -half_z - wall;
        builder.box({-half_x - wall, -0.1F, z0}, {-door_half, door_height, z0 + wall});
        builder.box({door_half, -0.1F, z0}, {half_x + wall, door_height, z0 + wall});
        builder.place(vec3(0, 0, z0));
        builder.prism(std::array{vec2(-half_x - wall, door_height), vec2(half_x + wall, door_height),
                                 vec2(half_x + wall, eave), vec2(0, ridge), vec2(-half_x - wall, eave)},
                      wall);
        builder.place(vec3(0));
    }
    builder.begin("roof", tin);
    const float out = half_x + 0.7F, drop = (ridge - eave) * 0.7F / half_x;
    builder.place(vec3(0, 0.02F, -half_z - 0.6F));
    for (const float side : {-1.0F, 1.0F}) {
        std::vector<vec2> plate{vec2(0, ridge), vec2(side * out, eave - drop), vec2(side * out, eave - drop + 0.14F),
                                vec2(0, ridge + 0.14F)};
        if (side < 0) {
            std::reverse(plate.begin(), plate.end());
        }
        builder.prism(plate, 2 * half_z + 1.2F);
    }
}

// Trusses under the roof and rows of racks with crates.
void add_contents(MeshBuilder& builder, int steel, int wood, int card) {
    builder.begin("trusses", steel);
    for (int i = 0; i < 6; ++i) {
        const float z = -half_z + (static_cast<float>(i) + 0.5F) * 2 * half_z / 6;
        builder.box({-half_x, 5.45F, z - 0.07F}, {half_x, 5.65F, z + 0.07F});
        for (int k = -3; k <= 3; ++k) {
            const float x = static_cast<float>(k) * half_x / 3.5F;
            builder.rod({x, 5.55F, z}, {x + (k < 0 ? 1.2F : (k > 0 ? -1.2F : 0.0F)), 7.9F - std::abs(x) * 0.215F, z},
                        0.05F, 6);
        }
    }
    Dice dice(83);
    for (const float x : {-6.4F, -2.9F, 4.6F}) {
        builder.begin("rack", steel);
        for (int bay = 0; bay <= 6; ++bay) {
            const float z = -9.0F + 2.6F * static_cast<float>(bay);
            for (const float dx : {-0.55F, 0.55F}) {
                builder.box({x + dx - 0.04F, -0.002F, z - 0.04F}, {x + dx + 0.04F, 3.6F, z + 0.04F});
            }
        }
        for (const float y : {0.25F, 1.75F, 3.2F}) {
            builder.box({x - 0.6F, y, -9.1F}, {x + 0.6F, y + 0.07F, 6.7F});
        }
        builder.begin("crates", x > 0 ? card : wood);
        for (const float y : {0.319F, 1.819F, 3.269F}) {
            for (int c = 0; c < 14; ++c) {
                if (dice.unit() < 0.3F) {
                    continue;
                }
                const float half = dice.between(0.28F, 0.45F), h = dice.between(0.4F, 1.1F);
                const float z = -8.6F + 1.08F * static_cast<float>(c);
                builder.place(vec3(x + dice.between(-0.08F, 0.08F), y, z), dice.between(-0.12F, 0.12F));
                builder.box({-half, 0, -half}, {half, h, half});
            }
        }
    }
    // Loose pallets and drums on the floor near the door.
    builder.begin("drums", steel);
    for (int i = 0; i < 6; ++i) {
        builder.place(vec3(1.0F + 0.75F * static_cast<float>(i % 3), -0.001F, 7.6F + 0.8F * static_cast<float>(i / 3)));
        builder.lathe(
            std::array{vec2(0.29F, 0), vec2(0.29F, 0.3F), vec2(0.305F, 0.31F), vec2(0.29F, 0.32F), vec2(0.29F, 0.88F)},
            18);
    }
}

Scene build() {
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("yard (sheet)", builder.material("asphalt", {0.24F, 0.24F, 0.25F}, 0.9F));
    builder.sheet({-150, -0.2F, 150}, {300, 0, 0}, {0, 0, -300});
    const int steel = builder.material("painted steel", {0.16F, 0.26F, 0.40F}, 0.5F);
    add_shell(builder, builder.material("brick", {0.46F, 0.26F, 0.19F}),
              builder.material("tin", {0.48F, 0.50F, 0.50F}, 0.5F), builder.material("screed", {0.46F, 0.44F, 0.40F}));
    add_contents(builder, steel, builder.material("pine", {0.52F, 0.36F, 0.20F}),
                 builder.material("cardboard", {0.50F, 0.38F, 0.26F}));
    builder.finish();
    return scene;
}

Scene make_inside(const ParamBlock& block) {
    Scene scene = build();
    const auto params = block.as<GnWarehouseParams>();
    const vec3 at(0.9F, 5.2F, 1.0F);
    scene.lights.push_back(
        sized_light(params.light, "lamp", at, {0.9F, 0, 0.9F}, params.size, 14000, 65, {1, 0.94F, 0.82F}));
    scene.cameras.push_back(look_at("main", {2.2F, 2.9F, 12.6F}, {0.1F, 1.5F, 0}, 55, 0.1F, 200));
    return scene;
}

Scene make_outside(const ParamBlock& block) {
    Scene scene = build();
    const auto params = block.as<GnWarehouseParams>();
    const vec3 at(44, 42, 52);
    scene.lights.push_back(sized_light(params.light, "flood light", at, {0, 2, 0}, params.size, 3000 * glm::dot(at, at),
                                       30, {1, 0.95F, 0.88F}));
    scene.cameras.push_back(look_at("main", {36, 28, 52}, {0, 2, 0}, 26, 0.1F, 400));
    return scene;
}

ParamTable params() {
    return param_table<GnWarehouseParams>(
        {GN_CHOICE(GnWarehouseParams, light, light_sentence, "rectangle", "spot"),
         GN_PARAM(GnWarehouseParams, size, real, 0.05, 4, "m", "Width of the light: softer shadows.")});
}

}  // namespace

const Generator& warehouse_inside() {
    static const Generator row{"warehouse-inside",
                               "A warehouse under one area light near its racks: soft shadows of many blockers.",
                               params(), make_inside};
    return row;
}

const Generator& warehouse_outside() {
    static const Generator row{"warehouse-outside",
                               "The same warehouse from outside, camera and light far away and close together.",
                               params(), make_outside};
    return row;
}

}  // namespace gn::scenes
