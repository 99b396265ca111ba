// SPDX-License-Identifier: MIT
// A corridor from 0.1 m to 500 m with skylights and things at every distance: texels per pixel vary by thousands.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

struct GnCorridorParams {
    float radius = 0;
};

constexpr double half_width = 3, wall_height = 4, length = 496, beam_spacing = 4, start = 4;

// The shell: floor, two walls, an end wall, and a roof of beams with a skylight between each two.
std::vector<SolidBox> shell() {
    std::vector<SolidBox> solids{
        {{-half_width - 0.4, -0.5, -length}, {half_width + 0.4, 0, start}},
        {{-half_width - 0.3, -0.2, -length + 0.1}, {-half_width, wall_height, start - 0.1}},
        {{half_width, -0.2, -length + 0.1}, {half_width + 0.3, wall_height, start - 0.1}},
        {{-half_width - 0.5, -0.6, -length - 1}, {half_width + 0.5, wall_height + 0.6, -length + 0.2}},
    };
    return solids;
}

std::vector<SolidBox> beams() {
    std::vector<SolidBox> solids;
    for (double z = start - 1; z > -length + beam_spacing; z -= beam_spacing) {
        solids.push_back(
            {{-half_width - 0.45, wall_height - 0.05, z - 1.1}, {half_width + 0.45, wall_height + 0.35, z + 1.1}});
    }
    return solids;
}

// Things on the floor whose distances from the camera grow by a fixed ratio, on alternating sides.
std::vector<SolidBox> things() {
    std::vector<SolidBox> solids;
    int k = 0;
    for (double distance = 0.35; distance < length - 4; distance *= 1.27, ++k) {
        const double side = k % 2 == 0 ? 1 : -1;
        const double x = side * std::min(0.25 + 0.28 * distance, 1.2 + 0.35 * (k % 4));
        const double half = 0.04 + std::min(0.03 * distance, 0.26 + 0.04 * (k % 3));
        const double top = std::min(0.5 + 0.25 * distance, 0.9 + 0.35 * (k % 5));
        solids.push_back({{x - half, 0, -distance - half}, {x + half, top, -distance + half}});
    }
    return solids;
}

Camera camera_at(std::string name, float z, float yaw) {
    const vec3 eye(0.1F, 1.55F, z);
    return look_at(std::move(name), eye, eye + vec3(std::sin(yaw), -0.16F, -std::cos(yaw)), 58, 0.1F, 500);
}

Scene make_corridor(const ParamBlock& block) {
    Scene scene;
    MeshBuilder builder(scene);
    const std::array groups{shell(), beams(), things()};
    const std::array names{"shell", "beams", "things"};
    const std::array materials{builder.material("plaster", {0.63F, 0.58F, 0.50F}),
                               builder.material("oak", {0.42F, 0.30F, 0.19F}),
                               builder.material("teal paint", {0.16F, 0.38F, 0.40F}, 0.5F)};
    std::vector<SolidBox> solids;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        // One object per box: a culler has something to cull.
        for (const SolidBox& solid : groups[g]) {
            builder.begin(fmt::format("{} {}", names[g], solids.size()), materials[g]);
            add_boxes(builder, {&solid, 1});
            solids.push_back(solid);
        }
    }
    builder.finish();

    scene.lights.push_back(
        directional_light("sun", {0.42F, 1.0F, 0.30F}, 40000, block.as<GnCorridorParams>().radius, {1, 0.95F, 0.86F}));
    scene.cameras.push_back(camera_at("main", 0, 0));
    scene.cameras.push_back(camera_at("middle", -150, 0.15F));

    // A slow walk of 5 cm a frame with a pan of 10 degrees to each side.
    CameraPath walk{"walk", {}};
    for (int frame = 0; frame < 24; ++frame) {
        const float t = static_cast<float>(frame) / 23;
        walk.frames.push_back(camera_at(fmt::format("walk {}", frame), -1.2F * t, 0.17F * std::sin(2 * pi * t)));
    }
    scene.paths.push_back(std::move(walk));

    // A point is dark exactly when its ray towards the sun meets a beam, a wall or a thing.
    scene.closed_form = [shape = scene.lights[0].shape, solids](std::size_t, dvec3 p_ws) {
        return box_visibility(shape, solids, p_ws);
    };
    return scene;
}

}  // namespace

const Generator& corridor() {
    static const Generator row{
        "corridor", "A corridor from 0.1 m to 500 m with skylights: breaks single maps by perspective aliasing.",
        param_table<GnCorridorParams>({GN_PARAM(GnCorridorParams, radius, real, 0, 5, "degrees",
                                                "Angular radius of the sun: 0 is a hard shadow.")}),
        make_corridor};
    return row;
}

}  // namespace gn::scenes
