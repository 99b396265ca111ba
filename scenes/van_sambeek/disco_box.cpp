// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// The scene "disco box" of section 4.1.2: a box among three near area lights in red, green and blue.
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"
#include "scenes/van_sambeek/lights.h"

namespace gn::scenes {
namespace {

struct GnDiscoParams {
    int light = as_rectangle;
    float size = 0.5F;
};

Scene make_disco_box(const ParamBlock& block) {
    const auto params = block.as<GnDiscoParams>();
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("floor (sheet)", builder.material("white floor", {0.72F, 0.72F, 0.72F}));
    builder.sheet({-12, 0, 12}, {24, 0, 0}, {0, 0, -24});
    builder.begin("box", builder.material("white box", {0.75F, 0.75F, 0.75F}, 0.5F));
    builder.place(vec3(0), 0.4F);
    builder.box({-0.5F, 0, -0.5F}, {0.5F, 1.0F, 0.5F});
    builder.finish();

    // The lights stand at the corners of a triangle; where all three meet the floor is white.
    const std::array<vec3, 3> colors{vec3(1, 0.06F, 0.06F), vec3(0.06F, 1, 0.06F), vec3(0.08F, 0.08F, 1)};
    const std::array names{"red", "green", "blue"};
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const float a = 2 * pi * (static_cast<float>(i) / 3 + 0.08F);
        const vec3 at(2.1F * std::sin(a), 2.3F, 2.1F * std::cos(a));
        scene.lights.push_back(sized_light(params.light, names[i], at, {0, 0.3F, 0}, params.size, 6000, 53, colors[i]));
    }
    scene.cameras.push_back(look_at("main", {0.9F, 3.4F, 3.6F}, {0, 0.15F, 0}, 45, 0.1F, 60));
    return scene;
}

}  // namespace

const Generator& disco_box() {
    static const Generator row{
        "disco-box", "A box among three near area lights in red, green and blue: overlapping soft shadows.",
        param_table<GnDiscoParams>(
            {GN_CHOICE(GnDiscoParams, light, light_sentence, "rectangle", "spot"),
             GN_PARAM(GnDiscoParams, size, real, 0.05, 1.5, "m", "Width of each light: softer shadows.")}),
        make_disco_box};
    return row;
}

}  // namespace gn::scenes
