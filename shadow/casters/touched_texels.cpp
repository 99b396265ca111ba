// SPDX-License-Identifier: MIT
// Based on: Hasselgren, Akenine-Moeller, Ohlsson. Conservative Rasterization. GPU Gems 2, 2005. [HAO05]
#include "shadow/casters/touched_texels.h"

#include "gpu/frame_graph.h"
#include "gpu/zeros_pass.h"
#include "shadow/receiver/line_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>
#include <cstring>
#include <set>

namespace gn {
namespace {

/// Workgroups that share out the large triangles, and those of which one takes many.
constexpr std::uint32_t large_groups = 256, huge_groups = 16, huge_shares = 32;

constexpr const char* shared_text = R"(
bool gn_cut = false;
GnTexelEdges gn_touched_edges(int index, vec3 a_ws, vec3 b_ws, vec3 c_ws) {
    GnLightView view = views[index];
    vec3 a = gn_texel_position(view, gn_clip(view, a_ws));
    vec3 b = gn_texel_position(view, gn_clip(view, b_ws));
    vec3 c = gn_texel_position(view, gn_clip(view, c_ws));
    ivec4 own = gn_tile_texels(view);
    return gn_texel_edges_grown(a, b, c, ivec4(own.xy, own.zw + 1), GN_MARGIN);
}
uint gn_touched_most(GnTexelEdges edges) {
    ivec2 size = max(edges.texels.zw - edges.texels.xy, ivec2(0));
    return uint(size.x) * uint(size.y);
}
)";

// What a triangle's own invocation does.
constexpr const char* small_main = R"(
layout(push_constant, scalar) uniform Push { uint first; uint count; } push;
layout(local_size_x = 64) in;
void main() {
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (i >= push.count * u.touched_views) {
        return;
    }
    uint triangle = push.first + i / u.touched_views;
    int index = int(i % u.touched_views);
    vec3 a_ws = touched_positions[touched_indices[3u * triangle]];
    vec3 b_ws = touched_positions[touched_indices[3u * triangle + 1u]];
    vec3 c_ws = touched_positions[touched_indices[3u * triangle + 2u]];
    GnTexelEdges edges = gn_touched_edges(index, a_ws, b_ws, c_ws);
    uint most = gn_touched_most(edges);
    if (most > GN_SMALL) {
        // Large ones from the front of the list, huge ones from its end.
        bool huge = most > GN_HUGE;
        uint slot = atomicAdd(touched_large[huge ? 1 : 0], 1u);
        touched_large[huge ? u.touched_slots + 1u - slot : 2u + slot] = triangle * u.touched_views + uint(index);
        most = 0u;
    }
    TRIANGLE_BODY
    uint width = uint(edges.texels.z - edges.texels.x);
    uint walked = 0u;
    for (uint i = 0u; i < most; ++i) {
        ivec3 texel = ivec3(edges.texels.xy + ivec2(i % width, i / width), views[index].layer);
        ivec3 block = ivec3(texel.xy / 8, texel.z);
        if (gn_touches(edges, texel.xy) && (WANTED)) {
            BODY
        }
        walked = i + 1u;
    }
    if (gn_cut || walked < most) {
        atomicOr(touched_cut, 1u);
    }
}
)";

// What one of `step` invocations does of a large one: its share of the texels, block by block.
constexpr const char* walk_text = R"(
void gn_touched_walk(uint triangle, int index, uint first, uint step) {
    vec3 a_ws = touched_positions[touched_indices[3u * triangle]];
    vec3 b_ws = touched_positions[touched_indices[3u * triangle + 1u]];
    vec3 c_ws = touched_positions[touched_indices[3u * triangle + 2u]];
    GnTexelEdges edges = gn_touched_edges(index, a_ws, b_ws, c_ws);
    TRIANGLE_BODY
    ivec4 blocks = ivec4(edges.texels.xy / 8, (edges.texels.zw + 7) / 8);
    uint across = uint(blocks.z - blocks.x);
    uint count = across * uint(max(blocks.w - blocks.y, 0)) * 64u;
    uint next = first;
    for (uint i = first; i < count; i += step) {
        ivec3 block = ivec3(blocks.xy + ivec2((i / 64u) % across, (i / 64u) / across), views[index].layer);
        ivec3 texel = ivec3(block.xy * 8 + ivec2(i % 8u, (i / 8u) % 8u), block.z);
        if (gn_touches_block(edges, block.xy * 8, 8) && gn_touches(edges, texel.xy) && (WANTED)) {
            BODY
        }
        next = i + step;
    }
    if (gn_cut || next < count) {
        atomicOr(touched_cut, 1u);
    }
}
)";

constexpr const char* large_main = R"(
layout(local_size_x = 64) in;
void main() {
    for (uint i = gl_WorkGroupID.x; i < touched_large[0]; i += gl_NumWorkGroups.x) {
        uint entry = touched_large[2u + i];
        gn_touched_walk(entry / u.touched_views, int(entry % u.touched_views),
                        gl_WorkGroupID.y * 64u + gl_LocalInvocationIndex, gl_NumWorkGroups.y * 64u);
    }
}
)";

constexpr const char* huge_main = R"(
layout(local_size_x = 64) in;
void main() {
    for (uint i = gl_WorkGroupID.x; i < touched_large[1]; i += gl_NumWorkGroups.x) {
        uint entry = touched_large[u.touched_slots + 1u - i];
        gn_touched_walk(entry / u.touched_views, int(entry % u.touched_views),
                        gl_WorkGroupID.y * 64u + gl_LocalInvocationIndex, gl_NumWorkGroups.y * 64u);
    }
}
)";

void replace(std::string& text, std::string_view word, std::string_view by) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size())) {
        text.replace(at, word.size(), by);
    }
}

std::string text_of(const TouchedTexels& touched, const ShaderInputs& inputs, const std::string& main) {
    std::string all = shared_text + main;
    replace(all, "TRIANGLE_BODY", touched.triangle_body);
    replace(all, "WANTED", touched.wanted);
    replace(all, "BODY", touched.body);
    // Texels that a triangle's own invocation walks, and those that its own workgroup does.
    return fmt::format("#define GN_SMALL {}u\n#define GN_HUGE 4096u\n#define GN_MARGIN ({})\n", touched.alone,
                       touched.margin) +
           include_line("shadow/light_view.h") + include_line("shadow/casters/conservative.glsl") +
           include_line("shadow/casters/tiles.glsl") + touched.includes + inputs.text() + touched.functions + all;
}

}  // namespace

// Some drivers end a loop after 65536 rounds and go on behind it: what is left out is said.
void tell_cut(const FrameInput& input, const std::string& name, BufferHandle cut) {
    input.graph.answer(cut, [name, remarks = input.late_remarks](std::span<const std::byte> bytes) {
        std::uint32_t was_cut = 0;
        std::memcpy(&was_cut, bytes.data(), sizeof was_cut);
        if (was_cut != 0 && remarks != nullptr) {
            remarks->insert(
                fmt::format("the driver ended a loop of pass '{}' early, so that shadows are missing in this frame; "
                            "a larger resolution makes loops shorter",
                            name));
        }
    });
}

void add_touched_texels(const FrameInput& input, const LightViews& views, const TouchedTexels& touched) {
    GN_CHECK(views.kind == ViewKind::affine || views.kind == ViewKind::perspective);
    FrameGraph& graph = input.graph;
    const auto count = static_cast<std::uint32_t>(views.views.size());
    std::uint64_t slots = 0;
    for (const TriangleRun& run : touched.runs) {
        slots += std::uint64_t{run.count} * count;
    }
    const BufferHandle large =
        graph.create(BufferDesc{.name = touched.name + " large", .bytes = (slots + 2) * sizeof(std::uint32_t)});
    const BufferHandle cut = graph.create(BufferDesc{.name = touched.name + " cut", .bytes = sizeof(std::uint32_t)});
    ShaderInputs inputs = view_list(views);
    inputs.add(touched.inputs);
    inputs.buffer("readonly buffer", "TouchedPositions", "vec3 touched_positions[];", input.handles.positions)
        .buffer("readonly buffer", "TouchedIndices", "uint touched_indices[];", input.handles.indices)
        .buffer("buffer", "TouchedLarge", "uint touched_large[];", large)
        .buffer("buffer", "TouchedCut", "uint touched_cut;", cut)
        .constant("uint", "touched_slots", static_cast<std::uint32_t>(slots))
        .constant("uint", "touched_views", count);
    const auto shader = [&](const char* what, const std::string& main) {
        Hasher key = hashed(inputs);
        key.text(touched.includes).text(touched.functions).text(touched.triangle_body).text(touched.body);
        key.value(touched.alone).text(touched.margin).text(touched.wanted);
        return compute_once(input.prepared, touched.name + what, key, [&] { return text_of(touched, inputs, main); });
    };
    add_zeros(graph, touched.name + ": none are large", {large, cut});
    graph.add_pass(
        touched.name, [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, count, runs = touched.runs, shader = shader("", small_main)](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            for (const TriangleRun& run : runs) {
                r.push_value(run);
                dispatch_line(r, run.count * count);
            }
        });
    graph.add_pass(
        touched.name + ": large", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shares = touched.shares,
         shader = shader(": large", std::string(walk_text) + large_main)](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(large_groups, shares);
        });
    graph.add_pass(
        touched.name + ": huge", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader = shader(": huge", std::string(walk_text) + huge_main)](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(huge_groups, huge_shares);
        });
    tell_cut(input, touched.name, cut);
}

}  // namespace gn
