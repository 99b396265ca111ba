// SPDX-License-Identifier: MIT
#include "tests/cascade_frame.h"

namespace gn::test {

glsl::GnReceiver receiver_at(float view_depth, vec2 p_ss) {
    glsl::GnReceiver receiver{};
    receiver.view_depth = view_depth;
    receiver.p_ss = p_ss;
    return receiver;
}

GnLight sun(vec3 direction_ws) {
    GnLight light;
    light.direction_ws = vec4(glm::normalize(direction_ws), 0);
    return light;
}

Scene with_hard_sun(const char* name) {
    Scene scene = built_in(name);
    scene.lights[0].shape.angular_radius = 0;
    return scene;
}

Rendered render(SceneGpu& gpu, const Camera& camera, const Camera& placed_by, const std::string& recipe_text,
                History* history) {
    const ValidationGuard guard;
    const Scene& scene = *gpu.scene;
    const Recipe recipe = load_recipe(recipe_text);
    check_recipe(recipe, scene, scene.lights[0], device());
    FrameGraph graph(device());
    const SceneHandles handles = import_scene(graph, gpu);
    ViewSamples samples = add_view_samples(graph, gpu, handles, camera, 160, 120);
    samples.camera = placed_by;
    const FrameInput input{device(), graph, scene, handles, samples, scene.lights.data(), 0, history};
    LightViews views = recipe.placement->place(input, recipe);
    views.part = recipe.placement;
    ShadowMap map = recipe.map->add_map(input, recipe, views);
    map.part = recipe.map;
    const Visibility visibility = add_resolve(input, recipe, views, map);
    for (const TextureHandle texture : {map.texture(), visibility.image, samples.position, samples.normal}) {
        graph.keep(texture);
    }
    if (views.buffer.valid()) {
        graph.keep(views.buffer);
        graph.keep(views.data_buffer);
    }
    graph.execute(false);
    if (history != nullptr) {
        history->advance();
    }

    Rendered result{.views = views.views, .casters = views.casters};
    copy_bytes(graph.download(visibility.image), result.visibility);
    for (std::uint32_t layer = 0; layer < views.layers; ++layer) {
        std::vector<float> texels;
        copy_bytes(graph.download(map.texture(), 0, layer), texels);
        result.map.insert(result.map.end(), texels.begin(), texels.end());
    }
    result.data = views.data_as<GnCascadesData>();
    if (views.buffer.valid()) {
        copy_bytes(graph.download(views.buffer), result.views);
        const std::vector<std::byte> data = graph.download(views.data_buffer);
        std::memcpy(&result.data, data.data(), sizeof result.data);
    }
    copy_bytes(graph.download(samples.position), result.samples.position_ws);
    copy_bytes(graph.download(samples.normal), result.samples.normal_ws);
    return result;
}

Camera moved(Camera camera, vec3 by_ws) {
    camera.position_ws += by_ws;
    return camera;
}

std::size_t differing(const std::vector<float>& a, const std::vector<float>& b) {
    EXPECT_EQ(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        count += std::memcmp(&a[i], &b[i], sizeof(float)) != 0 ? 1U : 0U;
    }
    return count;
}

}  // namespace gn::test
