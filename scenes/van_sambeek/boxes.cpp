// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// The scene "boxes" of section 4.1.2: fifty boxes on a grey plane under one distant area light, seen from afar.
#include "scenes/mesh_builder.h"
#include "scenes/noise.h"
#include "scenes/registry.h"
#include "scenes/van_sambeek/lights.h"

namespace gn::scenes {
namespace {

struct GnBoxesParams {
    int objects = 50;
    int light = as_rectangle;
    float size = 1.5F;
};

Scene make_boxes(const ParamBlock& block) {
    const auto params = block.as<GnBoxesParams>();
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("plane (sheet)", builder.material("grey", {0.45F, 0.45F, 0.45F}));
    builder.sheet({-40, 0, 40}, {80, 0, 0}, {0, 0, -80});
    const std::array paints{
        builder.material("ochre", {0.60F, 0.40F, 0.15F}), builder.material("brick", {0.50F, 0.18F, 0.12F}),
        builder.material("slate blue", {0.18F, 0.28F, 0.42F}), builder.material("ivory", {0.68F, 0.64F, 0.54F})};
    // One box a cell of a square raster, moved, turned and sized by the dice; the raster keeps them apart.
    Dice dice(61);
    for (int i = 0; i < params.objects; ++i) {
        const vec2 xz = raster_cell(i, params.objects);
        const vec3 cell(xz.x, 0, xz.y);
        const float half = dice.between(0.3F, 0.62F), height = dice.between(0.5F, 2.6F);
        builder.begin(fmt::format("box {}", i), paints[static_cast<std::size_t>(i) % paints.size()]);
        builder.place(2.1F * cell + vec3(dice.between(-0.25F, 0.25F), 0, dice.between(-0.25F, 0.25F)),
                      dice.between(0, pi));
        builder.box({-half, 0, -half * 0.8F}, {half, height, half * 0.8F});
    }
    builder.finish();

    const float extent = static_cast<float>(raster_columns(params.objects)) / 8;
    const vec3 at(9, 22, 7);
    scene.lights.push_back(
        sized_light(params.light, "key", at, vec3(0), params.size, 5000 * glm::dot(at, at), 40, {1, 0.95F, 0.86F}));
    scene.cameras.push_back(look_at("main", vec3(-9, 12, 17) * extent, {0, 0.2F, -0.5F}, 40, 0.1F, 200));
    return scene;
}

}  // namespace

const Generator& boxes() {
    static const Generator row{
        "boxes", "Fifty boxes on a grey plane under a distant area light: depth complexity.",
        param_table<GnBoxesParams>({
            GN_PARAM(GnBoxesParams, objects, integer, 1, 2000, "", "Number of boxes."),
            GN_CHOICE(GnBoxesParams, light, light_sentence, "rectangle", "spot"),
            GN_PARAM(GnBoxesParams, size, real, 0.05, 6, "m", "Width of the light: softer shadows."),
        }),
        make_boxes};
    return row;
}

}  // namespace gn::scenes
