// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02] Based on: Kim, Kim, Turk. A Shadow-Volume Algorithm for Opaque and Transparent Nonmanifold Casters. JGT 2008.
// [KKJ08] The lists of a light: which triangles are caps, which edges are sides.
#include "gpu/shader_inputs.h"
#include "gpu/zeros_pass.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/receiver/line_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>
#include <cmath>

namespace gn {

namespace {

constexpr const char* facing_text = "#include \"shadow/geometry/volume_facing.glsl\"\n";

constexpr const char* silhouette_text = R"(
layout(local_size_x = 64) in;
void main() {
    uint edge = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    // Lists that grow from their end begin where they stopped.
    if (edge == 0u) {
        draws[31] = 3u * u.frame.opaque_triangles - draws[29];
        draws[41] = 6u * u.frame.opaque_triangles - draws[39];
    }
    if (edge >= u.frame.edges) {
        return;
    }
    // Sum the directions in which the edge's triangles run through it, each turned to the light. What does not cancel is the
    // border of the volume: as many sides as are left over. [KKJ08] section 2
    int sum = 0;
    uint sides_of_all = 0u, end = first[edge + 1u];
    bool before = false;
    for (uint i = first[edge]; i < end; ++i) {
        int packed = multiplicity[around[i] >> 1];
        int m = gn_volumes_unpacked(packed);
        before = before || packed > 1;
        sum += (around[i] & 1u) != 0u ? -m : m;
        sides_of_all += uint(abs(m));
    }
    // Its component says where its volumes end.
    uint plane = end > first[edge] ? forms[owners[around[first[edge]] >> 1] >> 3] >> GN_VOLUMES_PLANE_SHIFT : 0u;
    uint count = u.frame.every != 0 ? sides_of_all : uint(abs(sum));
    if (count == 0u) {
        return;
    }
    uint slot = atomicAdd(draws[before ? 12 : 8], count * 6u) / 6u;
    atomicAdd(draws[before ? 4 : 0], count * gn_volumes_corners(u.frame));
    // By brute force as many run against the edge as are missing from the sum.
    uint against = sum < 0 ? count : 0u;
    against = u.frame.every != 0 ? uint(int(count) - sum) / 2u : against;
    for (uint i = 0u; i < count; ++i) {
        uint side = (plane << GN_VOLUMES_SIDE_BITS) + edge * 2u + (i < against ? 1u : 0u);
        sides[before ? u.frame.most_sides - 1u - slot - i : slot + i] = side;
    }
}
)";

/// A pass with an invocation for each of `count` things.
struct ListPass {
    const char* name;
    bool doubles;
    const char* text;
};
void add_list_pass(const FrameInput& input, const ListPass& pass, const ShaderInputs& inputs, std::uint32_t count) {
    const auto shader = compute_once(input.prepared, pass.name, hashed(inputs), [&] {
        return std::string(pass.doubles ? "#define GN_VOLUMES_DOUBLE\n" : "") +
               "#include \"shadow/geometry/volumes.glsl\"\n" + inputs.text() + pass.text;
    });
    add_line_pass(input.graph, pass.name, inputs, shader, count);
}

// Samples lie on the scene's surfaces, as casters do: no two are farther apart than its diagonal.
float reach_of_volumes(const FrameInput& input) {
    return is_orthographic(input.samples.camera) ? 1.01F * input.scene.bounds_ws.diagonal() : 0.0F;
}

}  // namespace

// The rasterizer rounds vertices to a grid of 2^-bits pixels: an edge moves by half a step along each axis at most.
// Twice that, so that rounding of the depths is covered too.
float snap_pixels(Device& device) {
    return std::ldexp(2.0F, -static_cast<int>(device.properties().limits.subPixelPrecisionBits));
}

float pixel_metres(const ViewSamples& samples) {
    return static_cast<float>(2 * half_height_at(samples.camera, 1) / samples.height);
}

double rounding_metres(const FrameInput& input) {
    const Camera& camera = input.samples.camera;
    const Box& bounds = input.scene.bounds_ws;
    const auto size = static_cast<double>(bounds.diagonal());
    const double far = is_orthographic(camera) ? 1.0 : size + glm::distance(camera.position_ws, bounds.centre());
    return 4.0 * snap_pixels(input.device) * pixel_metres(input.samples) * far + 1e-5 * size + 1e-30;
}

VolumeBuffers import_volume_buffers(const FrameInput& input, const VolumeOptions& options) {
    FrameGraph& graph = input.graph;
    VolumeBuffers buffers{.scene = edge_buffers(input, options)};
    buffers.mode = options.mode;
    const EdgeBuffers& scene = *buffers.scene;
    graph.hold(buffers.scene);
    buffers.positions = scene.proxies ? graph.import(scene.proxies->positions) : input.handles.positions;
    buffers.triangles = scene.proxies ? graph.import(scene.proxies->indices) : input.handles.indices;
    buffers.edges = graph.import(scene.edges);
    buffers.first = graph.import(scene.first);
    buffers.around = graph.import(scene.around);
    buffers.owners = graph.import(scene.owners);

    // Decide for each component how it casts; a buffer is never empty.
    const GnLight& light = input.light().shape;
    buffers.forms = component_forms(scene.list.components, light, options, &input.samples.constants.cs_from_ws);
    buffers.forms.resize(std::max<std::size_t>(buffers.forms.size(), 1), GN_VOLUMES_NONE);
    const vec4 light_ws = light_point_ws(light);
    if (options.covered) {
        leave_out_covered(input, scene, options, buffers.forms);
    }
    Box region;
    if (options.clamp) {
        region = volume_region(input);
        clamp_forms(scene.list.components, light_ws, region, buffers.forms);
    }
    buffers.frame = {.cs_from_ws = input.samples.constants.cs_from_ws,
                     .eye_ws = eye_of(input.samples.camera),
                     .light_ws = light_ws,
                     .triangles = static_cast<uint>(scene.casts.size()),
                     .edges = static_cast<uint>(scene.list.edges.size()),
                     .opaque_triangles = scene.opaque_triangles,
                     .most_sides = static_cast<uint>(scene.list.around.size()),
                     .snap = snap_pixels(input.device),
                     .pixel = pixel_metres(input.samples),
                     .reach = reach_of_volumes(input),
                     .capped = options.mode == VolumeMode::capped ? 1 : 0,
                     .low_ws = vec4(region.min, options.clamp ? 1.0F : 0.0F),
                     .high_ws = vec4(region.max, 0.0F),
                     .every = options.every_side ? 1 : 0};

    // The lists take the worst case: every triangle a cap, nothing cancelled at any edge.
    const VkDeviceSize triangles = buffers.frame.triangles;
    buffers.multiplicity = graph.create(BufferDesc{.name = "volume multiplicities", .bytes = triangles * 4});
    buffers.caps = graph.create(BufferDesc{.name = "volume caps", .bytes = triangles * 4});
    buffers.indices = graph.create(BufferDesc{
        .name = "volume cap indices", .bytes = std::max(VkDeviceSize{scene.opaque_triangles}, VkDeviceSize{1}) * 24});
    buffers.sides = graph.create(BufferDesc{.name = "volume sides", .bytes = scene.list.around.size() * 4});
    buffers.draws = graph.create(BufferDesc{.name = "volume draws", .bytes = draw_words * sizeof(std::uint32_t)});
    if (options.slices) {
        add_volume_slices(input, buffers);
    }
    return buffers;
}

void add_facing(const FrameInput& input, const VolumeBuffers& buffers) {
    add_zeros(input.graph, "volumes: empty lists", {buffers.draws});
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", buffers.positions)
        .buffer("readonly buffer", "Indices", "uint indices[];", buffers.triangles)
        .buffer("readonly buffer", "Owners", "uint owners[];", buffers.owners)
        .block("readonly buffer", "Forms", "uint forms[];", std::as_bytes(std::span(buffers.forms)))
        .buffer("writeonly buffer", "Multiplicity", "int multiplicity[];", buffers.multiplicity)
        .buffer("writeonly buffer", "Caps", "uint caps[];", buffers.caps)
        .buffer("writeonly buffer", "CapIndices", "uint cap_indices[];", buffers.indices)
        .buffer("buffer", "Draws", "uint draws[];", buffers.draws)
        .constant("GnVolumesFrame", "frame", buffers.frame);
    add_list_pass(input, {"volumes: facing", input.device.has(Feature::shader_float64), facing_text}, inputs,
                  buffers.frame.triangles);
}

void add_silhouettes(const FrameInput& input, const VolumeBuffers& buffers) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "First", "uint first[];", buffers.first)
        .buffer("readonly buffer", "Owners", "uint owners[];", buffers.owners)
        .block("readonly buffer", "Forms", "uint forms[];", std::as_bytes(std::span(buffers.forms)))
        .buffer("readonly buffer", "Around", "uint around[];", buffers.around)
        .buffer("readonly buffer", "Multiplicity", "int multiplicity[];", buffers.multiplicity)
        .buffer("writeonly buffer", "Sides", "uint sides[];", buffers.sides)
        .buffer("buffer", "Draws", "uint draws[];", buffers.draws)
        .constant("GnVolumesFrame", "frame", buffers.frame);
    add_list_pass(input, {"volumes: silhouettes", false, silhouette_text}, inputs, buffers.frame.edges);
}

VolumeBuffers add_all_silhouettes(const FrameInput& input, bool closed) {
    const VolumeBuffers buffers =
        import_volume_buffers(input, {.skip_masked = true, .closed = closed, .culling = false});
    add_facing(input, buffers);
    add_silhouettes(input, buffers);
    return buffers;
}

}  // namespace gn
