// SPDX-License-Identifier: MIT
// Blurs, mipmaps and tables over copies of the bytes that they must move.
#include "shadow/map/prefilter.h"
#include "tests/performance/bench.h"

namespace gn::performance {
namespace {

/// Copies a texture of two 32-bit floats a texel once: all of it read and written.
void build_copy(Bench& bench, FrameGraph& graph) {
    static constexpr const char* text = R"(
layout(location = 0) out vec4 out_texel;
void main() { out_texel = GN_SOURCE(ivec3(ivec2(gl_FragCoord.xy), push_layer)); }
)";
    SceneGpu& gpu = bench.scene("contact");
    const SceneHandles handles = import_scene(graph, gpu);
    const FrameInput input{bench.device(), graph, *gpu.scene, handles, {}};
    TextureDesc desc{.name = "source", .format = VK_FORMAT_R32G32_SFLOAT, .width = 1024, .height = 1024};
    const TextureHandle source = graph.create(desc);
    desc.name = "target";
    const TextureHandle target = graph.create(desc);
    graph.keep(target);
    graph.add_pass(
        "clear", [&](PassBuilder& pass) { pass.color(source, Load::clear); }, [](Recorder&) {});
    add_layer_passes(input, source, target, {.name = "copy", .text = text});
}

}  // namespace

void filters(Bench& bench) {
    const auto timed = [&](const std::string& recipe, std::vector<std::string> names) {
        return passes(bench, "courtyard", load_recipe(recipe + ",resolution=1024"), std::move(names));
    };
    const Timed copy = graph_passes(bench, [&](FrameGraph& graph) { build_copy(bench, graph); }, {"copy"});

    print_title("prefiltering over copying what it must move");
    for (const char* kernel : {"box", "gaussian"}) {
        for (const int radius : {1, 2, 4, 8}) {
            print_ratio(fmt::format("vsm, {} blur of {} x {}, over two copies", kernel, 2 * radius + 1, 2 * radius + 1),
                        timed(fmt::format("vsm,vsm.blur={},vsm.radius={}", kernel, radius), {"blur u", "blur v"}), copy,
                        2);
        }
    }
    print_ratio("vsm, mipmaps over a third of a copy", timed("vsm,vsm.mipmaps=1", {"mip"}), copy, 1.0 / 3.0);
    for (const char* table : {"float32", "uint32"}) {
        print_ratio(fmt::format("sat-vsm, {} table over two copies", table),
                    timed(fmt::format("sat-vsm,sat-vsm.table={}", table), {"sum rows", "sum columns"}), copy, 2);
    }

    print_title("map pass over depth's map pass");
    for (const char* recipe : {"vsm", "esm", "evsm2", "evsm4", "msm", "lvsm", "convolution"}) {
        print_ratio(recipe, timed(recipe, {"map"}), timed("hard", {"map"}));
    }
}

}  // namespace gn::performance
