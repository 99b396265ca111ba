// SPDX-License-Identifier: MIT
// Based on: Laine, Aila, Assarsson, Lehtinen, Akenine-Moller. Soft Shadow Volumes for Ray Tracing. ACM TOG 2005. [LAAL05]
#include "shadow/direct/depth_complexity/depth_complexity_edges.h"

#include "gpu/zeros_pass.h"
#include "shadow/direct/depth_complexity/depth_complexity.glsl"
#include "shadow/receiver/line_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* list_text = R"(
layout(local_size_x = 64) in;
void main() {
    uint edge = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (edge == 0u) {
        draws[9] = 1u;
    }
    if (edge >= u.frame.edges) {
        return;
    }
    // What is a silhouette from the centre, or beside a triangle that some points see from the other side.
    int sum = 0;
    bool cuts = false;
    uint end = first[edge + 1u];
    for (uint i = first[edge]; i < end; ++i) {
        uint t = around[i] >> 1;
        int m = gn_volumes_unpacked(multiplicity[t]);
        sum += (around[i] & 1u) != 0u ? -m : m;
        bool casts = (forms[owners[t] >> 3] & 3u) != uint(GN_VOLUMES_NONE);
        cuts = cuts || (casts && gn_depth_cuts_light(positions[indices[3u * t]], positions[indices[3u * t + 1u]],
                                                     positions[indices[3u * t + 2u]], u.frame.light_ws, u.x_ws.xyz,
                                                     u.y_ws.xyz, u.radius));
    }
    if (sum != 0 || cuts) {
        sides[atomicAdd(draws[8], 6u) / 6u] = edge * 2u;
    }
}
)";

}  // namespace

VolumeBuffers add_light_silhouettes(const FrameInput& input, bool closed) {
    const VolumeBuffers buffers =
        import_volume_buffers(input, {.skip_masked = true, .closed = closed, .culling = false});
    add_facing(input, buffers);
    VolumeBuffers found = buffers;
    FrameGraph& graph = input.graph;
    found.sides = graph.create(BufferDesc{.name = "depth-complexity edges",
                                          .bytes = buffers.scene->list.around.size() * sizeof(std::uint32_t)});
    found.draws =
        graph.create(BufferDesc{.name = "depth-complexity draws", .bytes = draw_words * sizeof(std::uint32_t)});
    add_zeros(graph, "depth-complexity: no edges", {found.draws});

    const GnLight& light = input.light().shape;
    const vec2 size = glsl::gn_light_half_size(light);
    const bool square = light.kind == GN_LIGHT_RECTANGLE;
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", input.handles.positions)
        .buffer("readonly buffer", "Indices", "uint indices[];", input.handles.indices)
        .buffer("readonly buffer", "First", "uint first[];", buffers.first)
        .buffer("readonly buffer", "Around", "uint around[];", buffers.around)
        .buffer("readonly buffer", "Owners", "uint owners[];", buffers.owners)
        .block("readonly buffer", "Forms", "uint forms[];", std::as_bytes(std::span(buffers.forms)))
        .buffer("readonly buffer", "Multiplicity", "int multiplicity[];", buffers.multiplicity)
        .buffer("writeonly buffer", "Sides", "uint sides[];", found.sides)
        .buffer("buffer", "Draws", "uint draws[];", found.draws)
        .constant("GnVolumesFrame", "frame", buffers.frame)
        .constant("vec4", "x_ws", square ? vec4(vec3(light.right_ws) * size.x, 0) : vec4(0))
        .constant("vec4", "y_ws", square ? vec4(vec3(light.up_ws) * size.y, 0) : vec4(0))
        .constant("float", "radius", glsl::gn_depth_radius(light));
    const auto shader = compute_once(input.prepared, "depth-complexity edges", hashed(inputs), [&] {
        return include_line("shadow/direct/depth_complexity/depth_complexity.glsl") + inputs.text() + list_text;
    });
    add_line_pass(graph, "depth-complexity: edges", inputs, shader, buffers.frame.edges);
    return found;
}

}  // namespace gn
