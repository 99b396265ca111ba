// SPDX-License-Identifier: MIT
// A half-plane over a parallel receiver: the penumbra every soft-shadow method has to get right first.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

constexpr float light_height = 4.0F, occluder_height = 2.0F;

Scene make_half_plane(const ParamBlock& block) {
    Scene scene;
    MeshBuilder builder(scene);
    const int floor = builder.material("chalk", {0.62F, 0.58F, 0.52F});
    const int board = builder.material("board", {0.25F, 0.36F, 0.42F});
    builder.begin("receiver (sheet)", floor);
    builder.sheet({-8, 0, 8}, {16, 0, 0}, {0, 0, -16});
    builder.begin("half-plane (sheet)", board);
    builder.sheet({-12, occluder_height, 12}, {12, 0, 0}, {0, 0, -24});
    builder.finish();

    scene.lights.push_back(overhead_light(block.as<GnOverheadLightParams>(), light_height));
    scene.cameras.push_back(look_at("main", {0.3F, 1.9F, 0.5F}, {0, 0, -0.2F}, 62, 0.1F, 40));
    // Of the penumbra's lit half alone: the edge of the hard shadow lies to the left of it.
    scene.cameras.push_back(look_at("beside", {0.85F, 1.2F, 0.3F}, {0.85F, 0, -0.2F}, 30, 0.1F, 40));

    // From x the edge at 0 projects onto the light at -x d_o / (d_r - d_o), with d_r = 4 m from light to receiver and
    // d_o = 2 m to the occluder; what lies left of it is hidden: V = clamp(1/2 + x d_o / (w (d_r - d_o)), 0, 1), a ramp
    // of width w (d_r - d_o) / d_o for a light of width w. The sheet form says the same with one border in the light.
    scene.closed_form = [light = scene.lights[0].shape](std::size_t, dvec3 p_ws) {
        const Sheet sheet{occluder_height, {-12, -12}, {0, 12}};
        return sheet_visibility(light, {&sheet, 1}, p_ws);
    };
    return scene;
}

}  // namespace

const Generator& half_plane() {
    static const Generator row{
        "half-plane",
        "A half-plane occluder over a parallel receiver: a linear penumbra; breaks wrong penumbra widths.",
        param_table<GnOverheadLightParams>(overhead_light_rows()), make_half_plane};
    return row;
}

}  // namespace gn::scenes
