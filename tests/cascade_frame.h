// SPDX-License-Identifier: MIT
// What the tests of cascades share: receivers made by hand, and a frame whose views and maps can be looked at.
#pragma once

#include "shadow/frame/history.h"
#include "shadow/placement/cascades/cascade_views.h"
#include "shadow/placement/cascades/cascades.glsl"
#include "tests/rig.h"

#include <cstring>

namespace gn::test {

inline glsl::GnReceiver receiver_at(float view_depth, vec2 p_ss = vec2(7.5F, 3.5F)) {
    glsl::GnReceiver receiver{};
    receiver.view_depth = view_depth;
    receiver.p_ss = p_ss;
    return receiver;
}

inline GnLight sun(vec3 direction_ws) {
    GnLight light;
    light.direction_ws = vec4(glm::normalize(direction_ws), 0);
    return light;
}

inline Scene with_hard_sun(const char* name) {
    Scene scene = load_scene(name);
    scene.lights[0].shape.angular_radius = 0;
    return scene;
}

/// A frame built by hand, so that tests can look at the views and the map, and place by another camera than the samples'.
struct Rendered {
    std::vector<float> visibility, map;
    std::vector<GnLightView> views;
    std::vector<std::vector<std::uint32_t>> casters;
    glsl::GnPlacementData data{};
    CpuSamples samples;
};

template <class T>
void copy_bytes(const std::vector<std::byte>& bytes, std::vector<T>& values) {
    values.resize(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
}

inline Rendered render(SceneGpu& gpu, const Camera& camera, const Camera& placed_by, const std::string& recipe_text,
                       History* history = nullptr) {
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
    std::copy(views.data.begin(), views.data.end(), result.data.values);
    if (views.buffer.valid()) {
        copy_bytes(graph.download(views.buffer), result.views);
        const std::vector<std::byte> data = graph.download(views.data_buffer);
        std::memcpy(&result.data, data.data(), sizeof result.data);
    }
    copy_bytes(graph.download(samples.position), result.samples.position_ws);
    copy_bytes(graph.download(samples.normal), result.samples.normal_ws);
    return result;
}

inline Camera moved(Camera camera, vec3 by_ws) {
    camera.position_ws += by_ws;
    return camera;
}

inline std::size_t differing(const std::vector<float>& a, const std::vector<float>& b) {
    EXPECT_EQ(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        count += std::memcmp(&a[i], &b[i], sizeof(float)) != 0 ? 1U : 0U;
    }
    return count;
}

}  // namespace gn::test
