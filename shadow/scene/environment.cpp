// SPDX-License-Identifier: MIT
#include "shadow/scene/clusters.h"
#include "shadow/scene/scene.h"

namespace gn {
namespace {

/// The share of the lights' illuminance that a sky of its own gives.
constexpr float share = 0.08F;

/// What the lights together give on the scene, lux.
float given_by_lights(const Scene& scene) {
    const Box around_ws = largest_cluster(scene);
    const float reach = around_ws.empty() ? 1.0F : 0.2F * around_ws.diagonal();
    float sum = 0;
    for (const Light& light : scene.lights) {
        const GnLight& shape = light.shape;
        const float area = 4 * shape.half_size.x * shape.half_size.y;
        sum += shape.kind == GN_LIGHT_DIRECTIONAL ? shape.intensity
               : shape.kind == GN_LIGHT_RECTANGLE ? shape.intensity * area / (reach * reach)
                                                  : 0.5F * shape.intensity / (reach * reach);
    }
    return sum;
}

}  // namespace

Light environment_of(const Scene& scene) {
    if (scene.environment) {
        return *scene.environment;
    }
    Light sky{.name = "sky", .shape = {}};
    sky.shape.kind = GN_LIGHT_ENVIRONMENT;
    sky.shape.intensity = share * given_by_lights(scene);
    return sky;
}

}  // namespace gn
