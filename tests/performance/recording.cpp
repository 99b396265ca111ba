// SPDX-License-Identifier: MIT
// What a steady frame costs the thread that records it: CPU time of declaring and recording, nothing that the device does.
#include "gpu/frames.h"
#include "shadow/frame/history.h"
#include "tests/performance/bench.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <span>

namespace gn::performance {
namespace {

constexpr int frames_recorded = 40, frames_warm = 4;
constexpr uint small_width = 64, small_height = 36;  // what the device draws is not timed

double thread_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

Texture2D receivers(Device& device, const char* name) {
    const std::vector<vec4> nothing(std::size_t{small_width} * small_height, vec4(0));
    return upload_texture(device,
                          {.name = name,
                           .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                           .width = small_width,
                           .height = small_height,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT},
                          std::as_bytes(std::span(nothing)));
}

struct Row {
    const char* recipe;
    uint kind;         ///< of the light: the scene's spot becomes one
    bool whole_frame;  ///< with the library's own view samples and shading, else on receivers that a host lends
};

/// The median of the recording thread's time for a frame, ms.
double recording_ms(Bench& bench, const std::string& scene_name, const Row& row) {
    Device& device = bench.device();
    SceneGpu& gpu = bench.scene(scene_name);
    Scene scene = *gpu.scene;
    scene.lights.front().shape.kind = row.kind;
    Texture2D position = receivers(device, "position");
    Texture2D normal = receivers(device, "normal");
    const PreparedRecipe recipe(device, load_recipe(row.recipe));
    Frames frames(device, 2);
    History history(device);
    std::vector<double> ms;
    for (int i = 0; i < frames_warm + frames_recorded; ++i) {
        Camera camera = scene.camera("");
        camera.position_ws.x += 0.01F * static_cast<float>(i);
        device.run([&](VkCommandBuffer commands) {
            const double start = thread_ms();
            frames.begin(static_cast<std::uint32_t>(i % 2));
            FrameGraph graph(device);
            const FrameCasters casters{scene, import_scene(graph, gpu)};
            const ViewSamples samples =
                row.whole_frame ? add_view_samples(graph, gpu, casters.handles, camera, small_width, small_height)
                                : lent_samples(graph, camera, graph.import(position), graph.import(normal));
            std::vector<TextureHandle> shadows;
            for (const LightShadow& shadow : add_frame(graph, samples, casters, lights_of(scene), recipe, &history)) {
                if (!shadow.refused.empty()) {
                    fail("{} with {}: {}", scene_name, row.recipe, shadow.refused);
                }
                shadows.push_back(shadow.visibility.image);
                graph.keep(shadows.back());
            }
            if (row.whole_frame) {
                FrameInput whole{device, graph, scene, casters.handles, samples};
                whole.prepared = &recipe;
                graph.keep(add_shading(whole, shadows));
            }
            graph.record(frames, commands);
            ms.push_back(thread_ms() - start);
        });
        history.advance();
    }
    std::sort(ms.begin() + frames_warm, ms.end());
    return ms[frames_warm + frames_recorded / 2];
}

void print_rows(Bench& bench, std::span<const Row> rows) {
    constexpr std::array<int, 4> objects{1, 25, 200, 1000};
    std::printf("\n| Recording thread, ms a frame, `grid` with objects: | 1 | 25 | 200 | 1000 |\n");
    std::printf("| --- | ---: | ---: | ---: | ---: |\n");
    for (const Row& row : rows) {
        std::printf("| %s, %s light, %s", row.recipe, std::string(light_kind_names.at(row.kind)).c_str(),
                    row.whole_frame ? "with view samples and shading" : "shadows alone");
        for (const int count : objects) {
            std::printf(" | %.3f", recording_ms(bench, "grid:objects=" + std::to_string(count), row));
            std::fflush(stdout);
        }
        std::printf(" |\n");
    }
}

}  // namespace

void recording(Bench& bench) {
    constexpr std::array<Row, 13> rows{
        {{"pcf", GN_LIGHT_SPOT, false},
         {"pcf", GN_LIGHT_POINT, false},
         {"cascades", GN_LIGHT_DIRECTIONAL, false},
         {"evsm2", GN_LIGHT_SPOT, false},
         {"vsm", GN_LIGHT_POINT, false},
         {"esm", GN_LIGHT_SPOT, false},
         {"sat-vsm", GN_LIGHT_SPOT, false},
         {"pcf,visibility=bilateral", GN_LIGHT_SPOT, false},
         {"hard,resolution=64,light=accumulate,accumulate.lights=4", GN_LIGHT_SPOT, false},
         {"hard,resolution=64,light=accumulate,accumulate.lights=64", GN_LIGHT_SPOT, false},
         {"pcf", GN_LIGHT_SPOT, true},
         {"pcf", GN_LIGHT_POINT, true},
         {"cascades", GN_LIGHT_DIRECTIONAL, true}}};
    print_rows(bench, rows);
}

void recording_geometry(Bench& bench) {
    constexpr std::array<Row, 3> rows{
        {{"volumes", GN_LIGHT_SPOT, true}, {"planar", GN_LIGHT_SPOT, true}, {"pcf", GN_LIGHT_SPOT, true}}};
    print_rows(bench, rows);
}

}  // namespace gn::performance
