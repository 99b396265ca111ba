// SPDX-License-Identifier: MIT
// A box that stands on the ground: the shadow has to start at its foot.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

struct GnContactParams {
    float elevation = 40;
    float radius = 0;
    int light = 0;
};

Scene make_contact(const ParamBlock& block) {
    using contact_scene::half_width, contact_scene::height;
    const auto params = block.as<GnContactParams>();
    const SolidBox box{{-half_width, 0, -half_width}, {half_width, height, half_width}};
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("ground (sheet)", builder.material("sandstone", {0.60F, 0.54F, 0.44F}));
    builder.sheet({-15, 0, 15}, {30, 0, 0}, {0, 0, -30});
    builder.begin("box", builder.material("painted wood", {0.24F, 0.40F, 0.48F}, 0.5F));
    add_boxes(builder, {&box, 1});
    builder.finish();

    // The light comes from the left and from behind, so that the foot of the shadow faces the camera.
    const float e = glm::radians(params.elevation);
    const vec3 to_light = std::cos(e) * glm::normalize(vec3(-0.8F, 0, -0.6F)) + vec3(0, std::sin(e), 0);
    Light light = directional_light("key", to_light, 1000, params.radius);
    if (params.light != 0) {
        const float distance = 9;
        light.shape.kind = params.light == 1 ? GN_LIGHT_SPOT : GN_LIGHT_POINT;
        light.shape.position_ws = vec4(to_light * distance, 0);
        light.shape.radius = distance * std::tan(light.shape.angular_radius);
        light.shape.angular_radius = 0;
        light.shape.intensity = 1000 * distance * distance;
        light.shape.cos_inner = std::cos(glm::radians(22.0F));
        light.shape.cos_outer = std::cos(glm::radians(28.0F));
    }
    scene.lights.push_back(light);
    scene.cameras.push_back(look_at("main", {1.6F, 2.1F, 3.1F}, {0.25F, 0.1F, 0.1F}, 45, 0.1F, 60));
    scene.cameras.push_back(look_at("foot", {1.5F, 0.8F, 1.5F}, {0.6F, 0, 0.3F}, 45, 0.05F, 60));

    // A point is dark exactly when its ray towards the light meets the box (slab test).
    scene.closed_form = [shape = scene.lights[0].shape, box](std::size_t, dvec3 p_ws) {
        return box_visibility(shape, {&box, 1}, p_ws);
    };
    return scene;
}

}  // namespace

const Generator& contact() {
    static const Generator row{
        "contact", "A box standing on the ground: breaks biases that are too large (detached shadows).",
        param_table<GnContactParams>({
            GN_PARAM(GnContactParams, elevation, real, 10, 80, "degrees",
                     "Height of the light above the horizon: shorter shadows."),
            GN_PARAM(GnContactParams, radius, real, 0, 5, "degrees",
                     "Angular radius of the light as seen from the box: 0 is hard."),
            GN_CHOICE(GnContactParams, light, "The kind of light.", "directional", "spot", "point"),
        }),
        make_contact};
    return row;
}

}  // namespace gn::scenes
