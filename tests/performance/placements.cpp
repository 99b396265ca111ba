// SPDX-License-Identifier: MIT
// Placements over others of as many texels, and kept maps over redrawn ones.
#include "shadow/frame/history.h"
#include "shadow/placement/place.h"
#include "tests/performance/bench.h"

namespace gn::performance {
namespace {

/// A pass that draws the same triangles into the same target with one matrix and no fragment stage.
void build_depth_only(Bench& bench, const Recipe& recipe, FrameGraph& graph) {
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

    SceneGpu& gpu = bench.scene("courtyard");
    const SceneHandles handles = import_scene(graph, gpu);
    const ViewSamples samples = {.width = bench.size().x, .height = bench.size().y, .camera = gpu.scene->cameras[0]};
    const FrameInput input{bench.device(), graph, *gpu.scene, handles, samples, gpu.scene->lights.data()};
    const LightViews views = place_views(input, recipe);
    const TextureHandle target = graph.create(
        {.name = "depth", .format = VK_FORMAT_D32_SFLOAT, .width = views.resolution, .height = views.resolution});
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
}

/// Making the maps of every frame along the scene's camera path but the first, which draws everything, ms.
Timed along_path(Bench& bench, std::string scene, const std::string& recipe_text) {
    return [&bench, scene = std::move(scene), recipe = load_recipe(recipe_text)] {
        SceneGpu& gpu = bench.scene(scene);
        History history(bench.device());
        double sum = 0;
        const std::vector<Camera>& frames = gpu.scene->paths.at(0).frames;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const FrameResult frame = render_frame(bench.device(), gpu, frames[i], recipe,
                                                   {.width = bench.size().x / 4,
                                                    .height = bench.size().y / 4,
                                                    .repeat = 1,
                                                    .only_light = 0,
                                                    .picture = false,
                                                    .history = &history});
            for (const PassTime& pass : frame.statistics.passes) {
                sum += i > 0 && pass.group == "shadow" && pass.name != "lookup" ? pass.ms : 0;
            }
        }
        return sum;
    };
}

void cascades_over_one(Bench& bench, const char* scene) {
    const Timed one = passes(bench, scene, load_recipe("pcf,placement=fit,resolution=1024"));
    for (const char* four :
         {"cascades.fit=stable", "cascades.fit=fitted", "cascades.fit=warped", "cascades.split=sdsm-minmax"}) {
        print_ratio(fmt::format("{}: 4 cascades of 512, {}, over fit of 1024", scene, four),
                    passes(bench, scene, load_recipe(fmt::format("pcf,placement=cascades,resolution=512,{}", four))),
                    one);
    }
}

void paraboloid_over_cube(Bench& bench, const char* scene, int light) {
    print_ratio(fmt::format("{}: paraboloid of 2 x 886 x 886 over cube of 6 x 512 x 512", scene),
                passes(bench, scene, load_recipe("pcf,placement=paraboloid,resolution=886"), {}, light),
                passes(bench, scene, load_recipe("pcf,placement=cube,resolution=512"), {}, light));
}

void kept_over_redrawn(Bench& bench, const char* scene) {
    const std::string base = "pcf,placement=cascades,resolution=1024";
    const Timed redrawn = along_path(bench, scene, base);
    for (const char* kept : {"cascades.scroll=1", "cascades.rate=8", "cascades.scroll=1,cascades.rate=8"}) {
        print_ratio(fmt::format("{}: {}", scene, kept), along_path(bench, scene, base + "," + kept), redrawn);
    }
}

}  // namespace

void placements(Bench& bench) {
    print_title("shadow time over one map of as many texels");
    cascades_over_one(bench, "courtyard");
    cascades_over_one(bench, "corridor");
    paraboloid_over_cube(bench, "contact:light=point", 0);
    paraboloid_over_cube(bench, "courtyard", 1);

    print_title("making 4 cascades of 1024 along the camera's path, kept over redrawn");
    kept_over_redrawn(bench, "courtyard");
    kept_over_redrawn(bench, "corridor");

    print_title("map pass over a depth-only pass of the same triangles");
    const Recipe hard = load_recipe("hard");
    print_ratio("courtyard, the sun", passes(bench, "courtyard", hard, {"map"}),
                graph_passes(bench, [&](FrameGraph& graph) { build_depth_only(bench, hard, graph); }, {"depth only"}));
}

}  // namespace gn::performance
