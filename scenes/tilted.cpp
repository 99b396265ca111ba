// SPDX-License-Identifier: MIT
// An unoccluded plane at an angle to the light: whatever is dark here is false self-shadowing.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

struct GnTiltedParams {
    float angle = 60;
    float radius = 0;
    int light = 0;
};

Scene make_tilted(const ParamBlock& block) {
    const auto params = block.as<GnTiltedParams>();
    // A plane in general position, so that no axis makes its depths exact by accident.
    const vec3 n = glm::normalize(vec3(0.31F, 1.0F, 0.23F));
    vec3 u, v;
    complete_frame(n, u, v);
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("plane (sheet)", builder.material("linen", {0.66F, 0.62F, 0.55F}));
    builder.sheet(-15.0F * u - 15.0F * v, 30.0F * u, 30.0F * v);
    builder.finish();

    // The light leans away from the normal by the angle, along neither of the plane's edges.
    const float angle = glm::radians(params.angle);
    const vec3 lean = glm::normalize(0.8F * u + 0.6F * v);
    const vec3 to_light = std::cos(angle) * n + std::sin(angle) * lean;
    Light light = directional_light("key", to_light, 1000, params.radius);
    if (params.light != 0) {
        const float distance = 8;
        light.shape.kind = params.light == 1 ? GN_LIGHT_SPOT : GN_LIGHT_POINT;
        light.shape.position_ws = vec4(to_light * distance, 0);
        light.shape.radius = distance * std::tan(light.shape.angular_radius);
        light.shape.angular_radius = 0;
        light.shape.intensity = 1000 * distance * distance;
        light.shape.cos_inner = std::cos(glm::radians(35.0F));
        light.shape.cos_outer = std::cos(glm::radians(40.0F));
    }
    scene.lights.push_back(light);
    scene.cameras.push_back(look_at("main", 2.4F * n + 1.1F * v, vec3(0), 55, 0.1F, 40));

    // Nothing blocks: V = 1, but for a light that dips below the plane's horizon. Seen from a corner of the plane a
    // near light of radius r at height h over it stays above as long as h > r.
    const double height = 8 * std::cos(static_cast<double>(angle));
    const bool above = params.light == 0 ? params.angle + params.radius < 90 : height > light.shape.radius;
    scene.closed_form = [above](std::size_t, dvec3) { return above ? std::optional(1.0) : std::nullopt; };
    return scene;
}

}  // namespace

const Generator& tilted() {
    static const Generator row{
        "tilted", "An unoccluded plane at any angle to the light: breaks biases that are too small (acne).",
        param_table<GnTiltedParams>({
            GN_PARAM(GnTiltedParams, angle, real, 0, 89, "degrees",
                     "Angle between the plane's normal and the light: more acne."),
            GN_PARAM(GnTiltedParams, radius, real, 0, 5, "degrees",
                     "Angular radius of the light as seen from the plane's centre."),
            GN_CHOICE(GnTiltedParams, light, "The kind of light.", "directional", "spot", "point"),
        }),
        make_tilted};
    return row;
}

}  // namespace gn::scenes
