// SPDX-License-Identifier: MIT
// Based on: Lloyd, Wendt, Govindaraju, Manocha. CC Shadow Volumes. EGSR 2004. [LWGM04] section 4.2, discrete shadow clamping
// Departs from it: slices are rows and columns of the picture, a volume is cut to the first and the last of either that may matter to
// it, and what lies in a slice is a box of its samples, where the paper asks occlusion queries for each slice.
#include "gpu/zeros_pass.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/geometry/volumes.glsl"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {

namespace {

constexpr const char* order_text = R"(
// A number of which order and bits agree, above 0 for all that is finite.
uint gn_volumes_ordered(float x) {
    uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float gn_volumes_unordered(uint order) {
    return uintBitsToFloat((order & 0x80000000u) != 0u ? order & 0x7FFFFFFFu : ~order);
}
)";

// The samples of a tile that count for the light: least and greatest coordinates, the least with their sign turned.
constexpr const char* boxes_text = R"(
layout(local_size_x = 16, local_size_y = 4) in;
void main() {
    uvec2 size = u.picture;
    uint column = gl_LocalInvocationID.x, y = gl_GlobalInvocationID.y;
    if (y >= size.y) {
        return;
    }
    uint row = y * uint(GN_VOLUMES_SLICES) / size.y;
    row += gn_volumes_slice(size.y, row + 1u) <= y ? 1u : 0u;
    vec3 low_ws = vec3(3.0e38), high_ws = vec3(-3.0e38);
    for (uint x = gn_volumes_slice(size.x, column); x < gn_volumes_slice(size.x, column + 1u); ++x) {
        vec4 p_ws = gbuffer_position_texel(ivec2(x, y));
        if (p_ws.w > 0.0 && gn_counted(u.whole, p_ws.xyz, gbuffer_normal_texel(ivec2(x, y)).xyz)) {
            low_ws = min(low_ws, p_ws.xyz);
            high_ws = max(high_ws, p_ws.xyz);
        }
    }
    if (low_ws.x > high_ws.x) {
        return;
    }
    uint tile = row * uint(GN_VOLUMES_SLICES) + column;
    for (uint axis = 0u; axis < 3u; ++axis) {
        atomicMax(tile_boxes[6u * tile + axis], gn_volumes_ordered(-low_ws[axis]));
        atomicMax(tile_boxes[6u * tile + 3u + axis], gn_volumes_ordered(high_ws[axis]));
    }
}
)";

// The first and last tiles whose samples may be in the component's volumes; an invocation a component and a row.
constexpr const char* runs_text = R"(
layout(local_size_x = 16, local_size_y = 4) in;
void main() {
    uint component = gl_WorkGroupID.x * 4u + gl_LocalInvocationID.y, row = gl_LocalInvocationID.x;
    if (component >= u.components) {
        return;
    }
    uint slices = uint(GN_VOLUMES_SLICES), form = forms[component];
    if ((form & 3u) == uint(GN_VOLUMES_NONE)) {
        return;
    }
    if ((form & uint(GN_VOLUMES_BEFORE | GN_VOLUMES_CAPPED)) != uint(GN_VOLUMES_BEFORE)) {
        atomicMax(runs[4u * component], slices);
        atomicMax(runs[4u * component + 1u], slices);
        atomicMax(runs[4u * component + 2u], slices);
        atomicMax(runs[4u * component + 3u], slices);
        return;
    }
    vec3 low_ws = boxes[2u * component].xyz, high_ws = boxes[2u * component + 1u].xyz;
    vec3 margin = vec3(u.margin) + 1.0e-5 * max(abs(low_ws), abs(high_ws));
    for (uint column = 0u; column < slices; ++column) {
        uint at = 6u * (row * slices + column);
        if (tile_boxes[at] == 0u) {
            continue;
        }
        vec3 from_ws = -vec3(gn_volumes_unordered(tile_boxes[at]), gn_volumes_unordered(tile_boxes[at + 1u]),
                             gn_volumes_unordered(tile_boxes[at + 2u]));
        vec3 to_ws = vec3(gn_volumes_unordered(tile_boxes[at + 3u]), gn_volumes_unordered(tile_boxes[at + 4u]),
                          gn_volumes_unordered(tile_boxes[at + 5u]));
        if (gn_volumes_may_hold(low_ws - margin, high_ws + margin, from_ws, to_ws, u.light_ws)) {
            atomicMax(runs[4u * component], slices - column);
            atomicMax(runs[4u * component + 1u], column + 1u);
            atomicMax(runs[4u * component + 2u], slices - row);
            atomicMax(runs[4u * component + 3u], row + 1u);
        }
    }
}
)";

}  // namespace

void add_volume_slices(const FrameInput& input, VolumeBuffers& buffers) {
    const auto components = static_cast<std::uint32_t>(buffers.forms.size());
    const VkDeviceSize tile_bytes = VkDeviceSize{GN_VOLUMES_SLICES} * GN_VOLUMES_SLICES * 6 * sizeof(std::uint32_t);
    const BufferHandle boxes = input.graph.create(BufferDesc{.name = "volume tile boxes", .bytes = tile_bytes});
    buffers.runs = input.graph.create(BufferDesc{.name = "volume runs", .bytes = components * sizeof(uvec4)});
    add_zeros(input.graph, "volumes: no tiles", {boxes, buffers.runs});
    const auto add = [&](const char* name, const char* text, const ShaderInputs& inputs, uvec2 groups) {
        const auto shader = compute_once(input.prepared, name, hashed(inputs), [&] {
            return include_line("shadow/scene/light.h") + include_line("shadow/geometry/volumes.glsl") + inputs.text() +
                   order_text + text;
        });
        input.graph.add_pass(
            name, [&](PassBuilder& pass) { inputs.declare(pass); },
            [shader, inputs, groups](Recorder& r) {
                r.bind(*shader);
                inputs.set(r);
                r.dispatch(groups.x, groups.y);
            });
    };

    // What lies in each tile of the picture.
    ShaderInputs tiles;
    add_gbuffer(tiles, input.device, input.samples);
    tiles.buffer("buffer", "TileBoxes", "uint tile_boxes[];", boxes)
        .constant("GnLight", "whole", input.whole_light().shape)
        .constant("uvec2", "picture", uvec2(input.samples.width, input.samples.height));
    add("volumes: tiles", boxes_text, tiles, {1, (input.samples.height + 3) / 4});

    // Which tiles matter to a component.
    ShaderInputs runs;
    runs.buffer("readonly buffer", "TileBoxes", "uint tile_boxes[];", boxes)
        .buffer("readonly buffer", "Boxes", "vec4 boxes[];", input.graph.import(buffers.scene->boxes))
        .buffer("buffer", "Runs", "uint runs[];", buffers.runs)
        .block("readonly buffer", "Forms", "uint forms[];", std::as_bytes(std::span(buffers.forms)))
        .constant("vec4", "light_ws", buffers.frame.light_ws)
        .constant("uint", "components", components)
        .constant("float", "margin", static_cast<float>(rounding_metres(input)));
    add("volumes: runs", runs_text, runs, {(components + 3) / 4, 1});
}

}  // namespace gn
