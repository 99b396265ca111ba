// SPDX-License-Identifier: MIT
#include "shadow/casters/tiles.h"

#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

/// A pass of one invocation a command; `body` reads `instances`, the number of views, and what `inputs` declare.
void add_commands(const FrameInput& input, const LightViews& views, ShaderInputs inputs, const char* body,
                  std::uint32_t commands) {
    if (views.count.valid()) {
        inputs.buffer("readonly buffer", "Count", "uint count;", views.count);
    }
    inputs.constant("uint", "most", static_cast<std::uint32_t>(views.views.size()));
    inputs.constant("uint", "commands", commands);
    const auto shader = compute_once(input.prepared, "tile draws", hashed(inputs), [&] {
        return inputs.text() + "layout(local_size_x = 64) in;\nvoid main() {\n" +
               "    uint i = gl_GlobalInvocationID.x;\n    if (i >= u.commands) {\n        return;\n    }\n" +
               (views.count.valid() ? "    uint instances = min(count, u.most);\n" : "    uint instances = u.most;\n") +
               body + "}\n";
    });
    input.graph.add_pass(
        "tile draws", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, commands, shader](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch((commands + 63) / 64, 1);
        });
}

}  // namespace

BufferHandle add_tile_draws(const FrameInput& input, const LightViews& views) {
    std::vector<uvec2> ranges;
    for (const Object& object : input.scene.objects) {
        ranges.emplace_back(object.first_triangle * 3, object.triangle_count * 3);
    }
    const auto count = static_cast<std::uint32_t>(ranges.size());
    ranges.resize(std::max<std::size_t>(ranges.size(), 1));
    const BufferHandle draws =
        input.graph.create({.name = "tile draws", .bytes = ranges.size() * sizeof(VkDrawIndexedIndirectCommand)});
    ShaderInputs inputs;
    inputs.block("readonly buffer", "Ranges", "uvec2 ranges[];", std::as_bytes(std::span(ranges)));
    inputs.buffer("writeonly buffer", "Draws", "uint draws[];", draws);
    add_commands(input, views, inputs, R"(
    uint command[5] = uint[](ranges[i].y, instances, ranges[i].x, 0u, 0u);
    for (uint word = 0u; word < 5u; ++word) {
        draws[5u * i + word] = command[word];
    }
)",
                 count);
    return draws;
}

BufferHandle add_tile_draw(const FrameInput& input, const LightViews& views, std::uint32_t vertices) {
    const BufferHandle draw = input.graph.create({.name = "tile draw", .bytes = sizeof(VkDrawIndirectCommand)});
    ShaderInputs inputs;
    inputs.buffer("writeonly buffer", "Draw", "uint vertices; uint copies; uint first_vertex; uint first_instance;",
                  draw);
    inputs.constant("uint", "corners", vertices);
    add_commands(input, views, inputs, R"(
    vertices = u.corners;
    copies = instances;
    first_vertex = 0u;
    first_instance = 0u;
)",
                 1);
    return draw;
}

RasterDesc tile_quads(ShaderSource fragment) {
    static constexpr const char* text = R"(
layout(push_constant) uniform Push { int layer; };
layout(location = 7) flat out int tile_view;
void main() {
    // Two triangles over the rectangle's texels.
    tile_view = gl_InstanceIndex;
    GnLightView view = views[tile_view];
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexIndex];
    vec2 p_cs = vec2((corner & 1) * 2 - 1, (corner & 2) - 1);
    gl_Position = gn_tile_in(view, layer) ? gn_tile_clip(view, vec4(p_cs, 0.0, 1.0)) : vec4(2.0, 2.0, 0.0, 1.0);
}
)";
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, "tile quads",
                   include_line("shadow/casters/tiles.glsl") + view_list({}).text() + text};
    desc.fragment = std::move(fragment);
    return desc;
}

}  // namespace gn
