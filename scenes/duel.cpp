// SPDX-License-Identifier: MIT
// The light looks into the camera: shadows run towards the viewer and no warp of the map can help ("duelling frusta").
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

struct GnDuelParams {
    float elevation = 14;
    float radius = 0;
    int light = 0;
};

// Standing stones in a loose double row that opens towards the camera.
std::vector<SolidBox> stones() {
    std::vector<SolidBox> solids;
    for (int row = 0; row < 7; ++row) {
        for (int side = -1; side <= 1; side += 2) {
            const double x = side * (1.3 + 0.35 * row) + 0.2 * ((row * 7 + side) % 3);
            const double z = -1.5 - 3.1 * row + 0.4 * side;
            const double half = 0.22 + 0.05 * ((row + side + 1) % 4);
            solids.push_back({{x - half, -0.05, z - 0.7 * half},
                              {x + half, 1.2 + 0.45 * ((row * 5 + side + 1) % 4), z + 0.7 * half}});
        }
    }
    solids.push_back({{-0.45, -0.05, -25.0}, {0.45, 2.4, -24.4}});
    return solids;
}

Scene make_duel(const ParamBlock& block) {
    const auto params = block.as<GnDuelParams>();
    const std::vector<SolidBox> solids = stones();
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("ground (sheet)", builder.material("dry grass", {0.50F, 0.46F, 0.30F}));
    builder.sheet({-120, 0, 60}, {240, 0, 0}, {0, 0, -240});
    builder.begin("stones", builder.material("granite", {0.45F, 0.45F, 0.47F}, 0.6F));
    add_boxes(builder, solids);
    builder.finish();

    // The camera looks down -z; the light comes from there.
    const float e = glm::radians(params.elevation);
    const vec3 to_light(0.03F, std::sin(e), -std::cos(e));
    Light light = directional_light("key", to_light, 8000, params.radius, {1, 0.86F, 0.68F});
    if (params.light != 0) {
        const float distance = 36;
        light.shape.kind = params.light == 1 ? GN_LIGHT_SPOT : GN_LIGHT_POINT;
        light.shape.position_ws = vec4(vec3(0, 0, -6) + glm::normalize(to_light) * distance, 0);
        light.shape.radius = distance * std::tan(light.shape.angular_radius);
        light.shape.angular_radius = 0;
        light.shape.intensity = 8000 * distance * distance;
        light.shape.cos_inner = std::cos(glm::radians(22.0F));
        light.shape.cos_outer = std::cos(glm::radians(30.0F));
    }
    scene.lights.push_back(light);
    scene.cameras.push_back(look_at("main", {0.4F, 2.3F, 6.0F}, {0, 0.1F, -4.0F}, 42, 0.1F, 200));

    // A point is dark exactly when its segment towards the light meets a stone.
    scene.closed_form = [shape = scene.lights[0].shape, solids](std::size_t, dvec3 p_ws) {
        return box_visibility(shape, solids, p_ws);
    };
    return scene;
}

}  // namespace

const Generator& duel() {
    static const Generator row{"duel", "The light faces the camera: breaks warped maps (duelling frusta).",
                               param_table<GnDuelParams>({
                                   GN_PARAM(GnDuelParams, elevation, real, 3, 60, "degrees",
                                            "Height of the light above the horizon: shorter shadows."),
                                   GN_PARAM(GnDuelParams, radius, real, 0, 5, "degrees",
                                            "Angular radius of the light as seen from the stones: 0 is hard."),
                                   GN_CHOICE(GnDuelParams, light, "The kind of light.", "directional", "spot", "point"),
                               }),
                               make_duel};
    return row;
}

}  // namespace gn::scenes
