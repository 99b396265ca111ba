// SPDX-License-Identifier: MIT
#include "shadow/casters/tiles.h"

#include "shadow/receiver/line_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>

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
               "    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + "
               "gl_LocalInvocationIndex;\n    if (i >= u.commands) {\n        return;\n    }\n" +
               (views.count.valid() ? "    uint instances = min(count, u.most);\n" : "    uint instances = u.most;\n") +
               body + "}\n";
    });
    add_line_pass(input.graph, "tile draws", inputs, shader, commands);
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

namespace {

/// An invocation an object: its views layer by layer, one after the other.
constexpr const char* lists_text = R"(
layout(local_size_x = 64) in;
void main() {
    uint object = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (object >= u.objects) {
        return;
    }
    GnTileCaster caster = casters[object];
    uint end = u.layers * u.objects + object * u.most;
    uint all = GN_TILE_COUNT;
    for (uint layer = 0u; layer < u.layers; ++layer) {
        uint draw = layer * u.objects + object;
        uint start = end;
        for (uint i = 0u; i < all; ++i) {
            if (gn_tile_in(views[i], int(layer)) && gn_tile_reached(views[i], caster.centre_ws, caster.half_ws)) {
                listed[end] = i;
                end += 1u;
            }
        }
        listed[draw] = start;
        draws[5u * draw] = caster.indices;
        draws[5u * draw + 1u] = end - start;
        draws[5u * draw + 2u] = caster.first_index;
        draws[5u * draw + 3u] = 0u;
        draws[5u * draw + 4u] = 0u;
    }
}
)";

/// Scalar layout.
struct TileCaster {
    vec3 centre_ws, half_ws;
    std::uint32_t first_index, indices;
};
constexpr const char* caster_text =
    "struct GnTileCaster { vec3 centre_ws; vec3 half_ws; uint first_index; uint indices; };\n";

std::vector<TileCaster> casters_of(const Scene& scene) {
    std::vector<TileCaster> casters;
    for (const Object& object : scene.objects) {
        casters.push_back({object.bounds_ws.centre(), 0.5F * object.bounds_ws.extent(), object.first_triangle * 3,
                           object.triangle_count * 3});
    }
    casters.resize(std::max<std::size_t>(casters.size(), 1));
    return casters;
}

}  // namespace

TileLists add_tile_lists(const FrameInput& input, const LightViews& views) {
    const std::vector<TileCaster> casters = casters_of(input.scene);
    const auto objects = static_cast<std::uint32_t>(casters.size());
    const auto most = static_cast<std::uint32_t>(views.views.size());
    const VkDeviceSize draws = VkDeviceSize{objects} * views.layers;
    const TileLists lists{
        input.graph.create({.name = "tile draws", .bytes = draws * sizeof(VkDrawIndexedIndirectCommand)}),
        input.graph.create({.name = "tile lists", .bytes = (draws + VkDeviceSize{objects} * most) * 4})};
    ShaderInputs inputs = view_list(views);
    inputs.block("readonly buffer", "Casters", "GnTileCaster casters[];", std::as_bytes(std::span(casters)))
        .buffer("writeonly buffer", "Draws", "uint draws[];", lists.draws)
        .buffer("writeonly buffer", "Listed", "uint listed[];", lists.views);
    if (views.count.valid()) {
        inputs.buffer("readonly buffer", "Count", "uint count;", views.count);
    }
    inputs.constant("uint", "objects", objects).constant("uint", "most", most).constant("uint", "layers", views.layers);
    const auto shader = compute_once(input.prepared, "tile lists", hashed(inputs), [&] {
        return include_line("shadow/casters/tiles.glsl") + caster_text + inputs.text() +
               (views.count.valid() ? "#define GN_TILE_COUNT min(count, u.most)\n" : "#define GN_TILE_COUNT u.most\n") +
               lists_text;
    });
    add_line_pass(input.graph, "tile lists", inputs, shader, objects);
    return lists;
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
