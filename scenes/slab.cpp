// SPDX-License-Identifier: MIT
// A rectangle over a parallel receiver: penumbrae that meet at corners.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

constexpr float lamp_height = 4.5F, slab_height = 1.5F, half_x = 0.6F, half_z = 0.4F;

Scene make_slab(const ParamBlock& block) {
    Scene scene;
    MeshBuilder builder(scene);
    const int floor = builder.material("clay", {0.60F, 0.47F, 0.38F});
    const int board = builder.material("slate", {0.20F, 0.24F, 0.28F});
    builder.begin("receiver (sheet)", floor);
    builder.sheet({-8, 0, 8}, {16, 0, 0}, {0, 0, -16});
    builder.begin("slab (sheet)", board);
    builder.sheet({-half_x, slab_height, half_z}, {2 * half_x, 0, 0}, {0, 0, -2 * half_z});
    builder.finish();

    scene.lights.push_back(overhead_light(block.as<GnOverheadLightParams>(), lamp_height));
    scene.cameras.push_back(look_at("main", {0.25F, 1.4F, 1.5F}, {0.05F, 0, 0.1F}, 60, 0.1F, 40));

    // The slab's projection covers the light by overlap_x times overlap_z, each a clipped linear ramp in the
    // receiver's x and z: V = 1 - overlap_x overlap_z / (w_x w_z).
    scene.closed_form = [light = scene.lights[0].shape](std::size_t, dvec3 p_ws) {
        const Sheet sheet{slab_height, {-half_x, -half_z}, {half_x, half_z}};
        return sheet_visibility(light, {&sheet, 1}, p_ws);
    };
    return scene;
}

}  // namespace

const Generator& slab() {
    static const Generator row{
        "slab", "A rectangle over a parallel receiver: a product of two ramps; breaks kernels of the wrong shape.",
        param_table<GnOverheadLightParams>(overhead_light_rows()), make_slab};
    return row;
}

}  // namespace gn::scenes
