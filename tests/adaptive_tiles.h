// SPDX-License-Identifier: MIT
// The tiles that placement `adaptive` makes of a frame, read back, and what each of the frame's samples asks for.
#pragma once

#include "shadow/placement/adaptive/adaptive.glsl"
#include "shadow/view/read_back.h"
#include "tests/rig.h"

#include <algorithm>
#include <cstring>

namespace gn::test {

/// A frame's tiles, as the GPU made them, and the samples that they are for.
struct Tiles {
    std::vector<GnLightView> views;
    std::vector<std::uint32_t> pages;
    GnAdaptiveData data;
    std::vector<vec4> rows;  ///< x, y and w of the map's view
    CpuSamples samples;
    GnViewConstants seen;
};
inline Tiles tiles_of(const Scene& scene, const std::string& text, uint width = 160, uint height = 90) {
    const ValidationGuard guard;
    SceneGpu gpu = upload_scene(device(), scene);
    FrameGraph graph(device());
    const SceneHandles handles = import_scene(graph, gpu);
    const ViewSamples samples = add_view_samples(graph, gpu, handles, scene.camera(""), width, height);
    const FrameInput input{device(), graph, scene, handles, samples, scene.lights.data()};
    const Recipe recipe = load_recipe(text);
    const LightViews views = recipe.placement->place(input, recipe);
    for (const BufferHandle buffer : {views.buffer, views.count, views.tables.front().buffer}) {
        graph.keep(buffer);
    }
    graph.keep(samples.position);
    graph.keep(samples.normal);
    graph.execute(false);
    Tiles tiles;
    const auto most = static_cast<std::uint32_t>(views.views.size());
    tiles.data = views.data_as<GnAdaptiveData>();
    tiles.samples = read_samples(graph, samples);
    tiles.seen = samples.constants;
    std::uint32_t count = 0;
    std::memcpy(&count, graph.download(views.count).data(), 4);
    EXPECT_LE(count, most);
    const auto read = [](auto& values, std::size_t size, const std::vector<std::byte>& bytes) {
        values.resize(size);
        std::memcpy(values.data(), bytes.data(), size * sizeof values[0]);
    };
    read(tiles.views, std::min(count, most), graph.download(views.buffer));
    const std::vector<std::byte> pages = graph.download(views.tables.front().buffer);
    read(tiles.pages, pages.size() / 4, pages);
    read(tiles.rows, views.tables.back().bytes.size() / sizeof(vec4), views.tables.back().bytes);
    return tiles;
}

/// Where a sample lies on the one map, and texels along its side at which a pixel has one where it has fewest; 0 of a sample that the
/// light does not reach.
struct Asked {
    vec2 uv{0};
    float texels = 0;
};
inline Asked asked_of(const Tiles& tiles, const GnLight& light, std::size_t i) {
    const vec4 position = tiles.samples.position_ws[i], normal = tiles.samples.normal_ws[i];
    glsl::GnReceiver receiver{};
    receiver.p_ws = vec3(position);
    receiver.n_ws = vec3(normal);
    if (position.w < 0.5F || !gn_counted(light, receiver.p_ws, receiver.n_ws)) {
        return {};
    }
    // As shadow/view/view.glsl steps along the plane.
    const auto step = [&](vec4 of_one_metre) {
        const vec3 across_ws = normal.w * vec3(of_one_metre);
        const vec3 ray_ws = across_ws + receiver.p_ws - vec3(tiles.seen.eye_ws);
        return across_ws - ray_ws * (glm::dot(receiver.n_ws, across_ws) / glm::dot(receiver.n_ws, ray_ws));
    };
    receiver.ddx_ws = step(tiles.seen.right_ws);
    receiver.ddy_ws = step(tiles.seen.down_ws);
    const glsl::GnAdaptivePlace place =
        glsl::gn_adaptive_place(tiles.rows[0], tiles.rows[1], tiles.rows[2], receiver.p_ws);
    return {place.uv, glsl::gn_undersampling(receiver, place.du_ws, place.dv_ws, 1)};
}

inline int node_at(const Tiles& tiles, vec2 uv, int level) {
    return glsl::gn_adaptive_node(tiles.data.levels, 0, level, glsl::gn_adaptive_cell(uv, level));
}

/// The finest level up to `most` that has a tile there.
inline int finest_at(const Tiles& tiles, vec2 uv, int most) {
    while (most > 0 && tiles.pages[static_cast<std::size_t>(node_at(tiles, uv, most))] == 0) {
        --most;
    }
    return most;
}

}  // namespace gn::test
