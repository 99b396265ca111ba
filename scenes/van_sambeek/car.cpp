// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// The scene "car" of section 4.1.2: a car on a box under two near area lights.
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"
#include "scenes/van_sambeek/lights.h"

namespace gn::scenes {
namespace {

struct GnCarParams {
    int light = as_rectangle;
    float size = 0.6F;
};

constexpr float stage = 0.25F;  // height of the box that the car stands on

// Across the car's length x and height y, extruded over its width.
void add_profile(MeshBuilder& builder, std::span<const vec2> outline, float half_width) {
    builder.place(vec3(0, stage, -half_width));
    builder.prism(outline, 2 * half_width);
}

void add_body(MeshBuilder& builder, int paint, int glass) {
    builder.begin("body", paint);
    const std::array lower{vec2(-2.05F, 0.32F), vec2(-1.95F, 0.24F), vec2(1.95F, 0.24F), vec2(2.08F, 0.34F),
                           vec2(2.06F, 0.60F),  vec2(1.90F, 0.70F),  vec2(0.95F, 0.84F), vec2(-1.75F, 0.86F),
                           vec2(-2.02F, 0.80F), vec2(-2.10F, 0.55F)};
    add_profile(builder, lower, 0.84F);
    builder.begin("cabin", glass);
    const std::array cabin{vec2(-1.45F, 0.82F), vec2(0.90F, 0.80F), vec2(0.30F, 1.28F), vec2(-0.85F, 1.30F)};
    add_profile(builder, cabin, 0.70F);
    builder.begin("roof", paint);
    const std::array roof{vec2(-0.90F, 1.285F), vec2(0.36F, 1.265F), vec2(0.22F, 1.34F), vec2(-0.78F, 1.36F)};
    add_profile(builder, roof, 0.72F);
    // Pillars in front of the glass, bumpers and mirrors.
    builder.begin("trim", paint);
    builder.place(vec3(0, stage, 0));
    for (const float z : {-0.705F, 0.705F}) {
        builder.rod({0.92F, 0.80F, z}, {0.30F, 1.29F, z}, 0.03F);
        builder.rod({-0.25F, 0.80F, z}, {-0.28F, 1.30F, z}, 0.03F);
        builder.rod({-1.46F, 0.82F, z}, {-0.85F, 1.31F, z}, 0.035F);
        builder.box({0.55F, 0.86F, z > 0 ? 0.80F : -0.98F}, {0.64F, 0.98F, z > 0 ? 0.98F : -0.80F});
    }
    builder.box({2.03F, 0.30F, -0.80F}, {2.16F, 0.44F, 0.80F});
    builder.box({-2.17F, 0.34F, -0.80F}, {-2.05F, 0.48F, 0.80F});
}

void add_wheels(MeshBuilder& builder, int rubber, int steel) {
    const std::array tyre{vec2(0.20F, -0.11F), vec2(0.29F, -0.11F), vec2(0.33F, -0.08F),
                          vec2(0.33F, 0.08F),  vec2(0.29F, 0.11F),  vec2(0.20F, 0.11F)};
    const std::array hub{vec2(0.205F, -0.09F), vec2(0.205F, 0.115F), vec2(0.06F, 0.13F)};
    for (const float x : {-1.30F, 1.32F}) {
        for (const float z : {-0.80F, 0.80F}) {
            const mat4 axle = glm::rotate(glm::translate(mat4(1), vec3(x, stage + 0.329F, z)), z > 0 ? pi / 2 : -pi / 2,
                                          vec3(1, 0, 0));
            builder.begin("tyre", rubber);
            builder.place(axle);
            builder.lathe(tyre, 28);
            builder.begin("hub", steel);
            builder.place(axle);
            builder.lathe(hub, 14);
        }
    }
}

Scene make_car(const ParamBlock& block) {
    const auto params = block.as<GnCarParams>();
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("floor (sheet)", builder.material("concrete", {0.48F, 0.47F, 0.45F}));
    builder.sheet({-20, 0, 20}, {40, 0, 0}, {0, 0, -40});
    builder.begin("stage", builder.material("stage", {0.62F, 0.60F, 0.56F}));
    builder.chamfered_slab({-3.2F, -0.05F, -1.9F}, {3.2F, stage, 1.9F}, 0.02F);
    add_body(builder, builder.material("red paint", {0.50F, 0.05F, 0.04F}, 0.3F),
             builder.material("glass", {0.04F, 0.05F, 0.06F}, 0.15F));
    add_wheels(builder, builder.material("rubber", {0.03F, 0.03F, 0.03F}, 0.9F),
               builder.material("steel", {0.5F, 0.5F, 0.52F}, 0.4F, 0.6F));
    builder.finish();

    // 1000 lux from each light at the height of the roof, whatever the size.
    scene.lights.push_back(sized_light(params.light, "front", {2.2F, 4.0F, 1.6F}, {0.2F, 0.5F, 0}, params.size, 9000,
                                       54, {1, 0.93F, 0.82F}));
    scene.lights.push_back(sized_light(params.light, "rear", {-2.6F, 3.8F, -0.8F}, {-0.2F, 0.5F, 0}, params.size, 9000,
                                       54, {0.82F, 0.9F, 1}));
    scene.cameras.push_back(look_at("main", {3.9F, 2.6F, 4.6F}, {0.1F, 0.55F, 0.1F}, 40, 0.1F, 80));
    return scene;
}

}  // namespace

const Generator& car() {
    static const Generator row{
        "car", "A car on a box under two near area lights: wide penumbrae.",
        param_table<GnCarParams>(
            {GN_CHOICE(GnCarParams, light, light_sentence, "rectangle", "spot"),
             GN_PARAM(GnCarParams, size, real, 0.05, 2, "m", "Width of each light: softer shadows.")}),
        make_car};
    return row;
}

}  // namespace gn::scenes
