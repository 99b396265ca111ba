// SPDX-License-Identifier: MIT
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
// Three parallel planes (fig. 3.4): A shades half of B, B hides C, and variance maps let A's penumbra through to C.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

using namespace stack_scene;

struct GnStackParams {
    float radius = 0;
};

Scene make_stack(const ParamBlock& block) {
    const std::vector<Sheet> sheets{{height_a, {-6, -6}, {edge_x, 6}},
                                    {height_b, {-half_width_b, -half_width_b}, {half_width_b, half_width_b}}};
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("C (sheet)", builder.material("sand", {0.62F, 0.55F, 0.42F}));
    builder.sheet({-8, height_c, 8}, {16, 0, 0}, {0, 0, -16});
    const std::array colors{builder.material("copper", {0.5F, 0.28F, 0.18F}),
                            builder.material("sage", {0.36F, 0.45F, 0.33F})};
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        const Sheet& s = sheets[i];
        builder.begin(i == 0 ? "A (sheet)" : "B (sheet)", colors[i]);
        builder.sheet(vec3(s.low.x, s.y, s.high.y), vec3(s.high.x - s.low.x, 0, 0), vec3(0, 0, s.low.y - s.high.y));
    }
    builder.finish();

    scene.lights.push_back(directional_light("key", {0, 1, 0}, 1000, block.as<GnStackParams>().radius));
    scene.cameras.push_back(look_at("main", {0.9F, 2.5F, 3.3F}, {0.1F, 0.45F, 0}, 50, 0.1F, 40));
    scene.cameras.push_back(look_at("under", {0.5F, 1.2F, 1.9F}, {0, 0, -0.1F}, 60, 0.1F, 40));

    // Light falls straight down, so a point is dark exactly when A or B covers its x and z from above.
    scene.closed_form = [light = scene.lights[0].shape, sheets](std::size_t, dvec3 p_ws) {
        return sheet_visibility(light, sheets, p_ws);
    };
    return scene;
}

}  // namespace

const Generator& stack() {
    static const Generator row{
        "stack", "Three parallel planes, the middle one half in shadow: breaks variance maps by light bleeding.",
        param_table<GnStackParams>({GN_PARAM(GnStackParams, radius, real, 0, 10, "degrees",
                                             "Angular radius of the sun: 0 is a hard shadow.")}),
        make_stack};
    return row;
}

}  // namespace gn::scenes
