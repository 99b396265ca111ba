// SPDX-License-Identifier: MIT
// What shadows cost over the least that any method must pay, as ratios of one run: `make bench` prints the table of
// docs/performance.md. Nothing here is asserted.
#include "base/stats.h"
#include "shadow/frame.h"

#include <cstdio>

namespace gn {
namespace {

constexpr int repeats = 15;

/// A lookup that only fetches, as a part that no registry knows.
Part fetching(std::string_view id) {
    Part part;
    part.id = id;
    part.stage = Stage::lookup;
    part.needs = "depth";
    part.glsl = "tests/performance/fetch.glsl";
    return part;
}

struct Measured {
    double map = 0, lookup = 0;
};

Measured measure(Device& device, SceneGpu& gpu, const Recipe& recipe, std::size_t light) {
    const FrameResult frame = render_frame(
        device, gpu, gpu.scene->cameras[0], recipe,
        {.width = 960, .height = 540, .repeat = repeats, .only_light = static_cast<int>(light), .picture = false});
    Measured result;
    for (const PassTime& pass : frame.statistics.passes) {
        result.map += pass.name == "map" ? pass.ms : 0;
        result.lookup += pass.name == "lookup" ? pass.ms : 0;
    }
    return result;
}

/// A pass that draws the same triangles into the same target with one matrix and no fragment stage.
double depth_only(Device& device, SceneGpu& gpu, std::uint32_t resolution) {
    static constexpr const char* text = R"(
layout(location = 0) in vec3 in_position_ws;
layout(push_constant) uniform Push { mat4 cs_from_ws; } push;
void main() { gl_Position = push.cs_from_ws * vec4(in_position_ws, 1.0); }
)";
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, "depth only", text};
    desc.depth_test = desc.depth_write = desc.depth_clamp = true;
    desc.depth_compare = VK_COMPARE_OP_LESS;
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
    desc.vertex_stride = sizeof(vec3);

    FrameGraph graph(device);
    const SceneHandles handles = import_scene(graph, gpu);
    const ViewSamples samples = {.width = 960, .height = 540, .camera = gpu.scene->cameras[0]};
    const FrameInput input{device, graph, *gpu.scene, handles, samples, nullptr, 0};
    Recipe recipe = load_recipe(fmt::format("hard,resolution={}", resolution));
    const LightViews views = recipe.placement_for(input.light().shape).place(input, recipe);
    const TextureHandle target =
        graph.create({.name = "depth", .format = VK_FORMAT_D32_SFLOAT, .width = resolution, .height = resolution});
    graph.keep(target);
    graph.add_pass(
        "depth only",
        [&](PassBuilder& pass) {
            pass.depth(target, Load::clear, {.depth = 1.0F});
            pass.vertices(handles.positions);
            pass.indices(handles.indices);
        },
        [=, scene = gpu.scene](Recorder& r) {
            r.bind(desc);
            r.vertex_buffer(handles.positions);
            r.index_buffer(handles.indices);
            r.push_value(views.views[0].cs_from_ws);
            r.draw_indexed(static_cast<std::uint32_t>(3 * scene->triangles.size()));
        });
    graph.execute(false);
    std::vector<double> times;
    for (int i = 0; i < repeats; ++i) {
        graph.execute(true);
        times.push_back(graph.statistics().passes.at(0).ms);
    }
    return median(times);
}

void print_row(const char* what, double a, double b) {
    std::printf("| %s | %.2f |\n", what, a / b);
}

}  // namespace
}  // namespace gn

int main() try {
    using namespace gn;
    const auto device = Device::create();
    std::printf("Device: %s (%s)\n\n| ratio | value |\n| --- | ---: |\n", device->info().name.c_str(),
                device->info().driver.c_str());
    const Scene scene = load_scene("courtyard");
    SceneGpu gpu = upload_scene(*device, scene);

    Recipe hard = load_recipe("hard");
    Recipe pcf = load_recipe("pcf,pcf.kernel=3x3");
    const Part one = fetching("fetch-one");
    const Part grid = fetching("fetch-grid");
    Recipe fetch_one = hard;
    fetch_one.lookup = &one;
    Recipe fetch_grid = hard;
    fetch_grid.lookup = &grid;

    const Measured hard_ms = measure(*device, gpu, hard, 0);
    const Measured one_ms = measure(*device, gpu, fetch_one, 0);
    const Measured pcf_ms = measure(*device, gpu, pcf, 0);
    const Measured grid_ms = measure(*device, gpu, fetch_grid, 0);
    print_row("hard lookup over one fetch", hard_ms.lookup, one_ms.lookup);
    print_row("pcf 3x3 lookup over fetching the same texels", pcf_ms.lookup, grid_ms.lookup);
    print_row("pcf 3x3 lookup over hard lookup", pcf_ms.lookup, hard_ms.lookup);
    print_row("map pass over a depth-only pass of the same triangles", hard_ms.map,
              depth_only(*device, gpu, static_cast<std::uint32_t>(hard.resolution)));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "ratios: %s\n", error.what());
    return 1;
}
