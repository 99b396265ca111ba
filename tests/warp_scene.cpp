// SPDX-License-Identifier: MIT
#include "tests/warp_scene.h"

namespace gn::test {

LightViews place(const Scene& scene, const std::string& text, uint width, uint height, const Camera* camera) {
    FrameGraph graph(device());
    const SceneHandles handles;
    const ViewSamples samples{
        .width = width, .height = height, .camera = camera != nullptr ? *camera : scene.cameras.front()};
    const FrameInput input{device(), graph, scene, handles, samples, scene.lights.data()};
    return place_views(input, load_recipe(text));
}

Scene long_floor(double near, double far, vec3 to_light) {
    Scene scene;
    scene.bounds_ws = Box{vec3(-400, -1e-3F, static_cast<float>(-far)), vec3(400, 0, static_cast<float>(-near))};
    scene.cameras.push_back({.position_ws = vec3(0, 0.5F, 0), .yfov = 1.2F, .near = 0.1F, .far = 1e4F});
    scene.lights.push_back({"sun", {}});
    scene.lights[0].shape.direction_ws = vec4(-glm::normalize(to_light), 0);
    return scene;
}

dvec2 uv_of(const GnLightView& view, dvec3 p_ws) {
    const dvec4 p_cs = dmat4(view.cs_from_ws) * dvec4(p_ws, 1);
    const dvec2 p_ndc = dvec2(p_cs) / p_cs.w;
    // The rows of a logarithmic view, shadow/receiver/logarithm.glsl.
    const double rate = -static_cast<double>(view.paraboloid);
    return {p_ndc.x * 0.5 + 0.5, rate > 0 ? -std::log(p_ndc.y) / rate : p_ndc.y * 0.5 + 0.5};
}

double error_along(const GnLightView& view, dvec3 p_ws, dvec3 direction_ws, double depth) {
    const double step = 1e-4 * depth;
    const dvec2 change = uv_of(view, p_ws + step * direction_ws) - uv_of(view, p_ws - step * direction_ws);
    return 2 * step / (glm::length(change) * depth);
}

}  // namespace gn::test
