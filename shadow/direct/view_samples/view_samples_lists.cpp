// SPDX-License-Identifier: MIT
// Based on: Sintorn, Eisemann, Assarsson. Sample Based Visibility for Soft Shadows using Alias-free Shadow Maps. EGSR 2008. [SEA08]
// Section 4: lists of view samples are compact, each behind the one before, by a running sum of their lengths.
#include "shadow/direct/view_samples/view_samples_lists.h"

#include "gpu/zeros_pass.h"
#include "shadow/receiver/line_pass.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <bit>

namespace gn {
namespace {

// Every sample counts itself in its texel. Where two views overlap the first serves; what lies behind the light may stand anywhere.
constexpr const char* count_text = R"(
uint gn_spread(uint x) {
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
}
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    GnReceiver receiver;
    uvec2 entry = uvec2(0u);
    if (read_sample(pixel, receiver)) {
        ivec3 texel = max(gn_irregular_z_texel(views[GN_CHOOSE(receiver, placement).first], receiver.p_ws), ivec3(0));
        uint cell = (uint(texel.z) << (2u * u.cell_bits)) | gn_spread(uint(texel.x)) | (gn_spread(uint(texel.y)) << 1);
        entry = uvec2(cell + 1u, atomicAdd(cells[cell], 1u));
    }
    entries[uint(pixel.y) * u.view.size.x + uint(pixel.x)] = entry;
}
)";

// Each run of 128 texels, summed.
constexpr const char* sums_text = R"(
layout(local_size_x = 64) in;
void main() {
    uint run = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (run >= u.runs) {
        return;
    }
    uint sum = 0u;
    for (uint i = 0u; i < 128u; ++i) {
        sum += cells[128u * run + i];
    }
    sums[run] = sum;
}
)";

// Where each run begins: one workgroup goes through all sums.
constexpr const char* starts_text = R"(
layout(local_size_x = 64) in;
shared uint parts[64];
void main() {
    uint each = (u.runs + 63u) / 64u;
    uint first = min(gl_LocalInvocationIndex * each, u.runs);
    uint end = min(first + each, u.runs);
    uint sum = 0u;
    for (uint i = first; i < end; ++i) {
        sum += sums[i];
    }
    parts[gl_LocalInvocationIndex] = sum;
    barrier();
    uint before = 0u;
    for (uint i = 0u; i < gl_LocalInvocationIndex; ++i) {
        before += parts[i];
    }
    if (gl_LocalInvocationIndex == 63u) {
        used = before + sum;
    }
    for (uint i = first; i < end; ++i) {
        uint length = sums[i];
        sums[i] = before;
        before += length;
    }
}
)";

// Where each texel's list begins; its end is where the next one does.
constexpr const char* cells_text = R"(
layout(local_size_x = 64) in;
void main() {
    uint run = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (run >= u.runs) {
        return;
    }
    uint before = sums[run];
    for (uint i = 128u * run; i < 128u * run + 128u; ++i) {
        uint length = cells[i];
        cells[i] = before;
        before += length;
    }
    if (run == u.runs - 1u) {
        cells[128u * u.runs] = before;
    }
}
)";

// Every sample takes its place, and is a leaf.
constexpr const char* scatter_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, u.size))) {
        return;
    }
    uint index = pixel.y * u.size.x + pixel.x;
    uvec2 entry = entries[index];
    if (entry.x == 0u) {
        return;
    }
    uint place = cells[entry.x - 1u] + entry.y;
    entries[index] = uvec2(place + 1u, cells[entry.x] - cells[entry.x - 1u]);
    vec3 p_ws = gbuffer_position_texel(ivec2(pixel)).xyz;
    vec3 n_ws = gbuffer_normal_texel(ivec2(pixel)).xyz;
    points[2u * place] = uvec4(floatBitsToUint(p_ws), index);
    points[2u * place + 1u] = uvec4(floatBitsToUint(n_ws), 0u);
    uint each = 1u << (2u * GN_LEVELS);
    uint at = place / each * gn_tree_nodes(GN_LEVELS) + gn_tree_node(place % each, 0u, GN_LEVELS);
    vec3 p_ls = gn_ls_from_ws(u.axes, p_ws);
    nodes[at] = SampleNode(p_ls, at + 1u, p_ls, place + 1u);
}
)";

// Boxes around what hangs `u.below` levels down, or where that is none fewer: u.below + 1 to u.below + 3 levels above the samples.
constexpr const char* boxes_text = R"(
layout(local_size_x = 64) in;
void main() {
    uint above = 1u;
    uint inner = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    for (; above < 3u && inner >= u.places >> (2u * (u.below + above)); ++above) {
        inner -= u.places >> (2u * (u.below + above));
    }
    uint level = u.below + above;
    uint first = inner << (2u * level);
    if (first >= used) {
        return;
    }
    uint each = 1u << (2u * GN_LEVELS);
    uint tree = first / each * gn_tree_nodes(GN_LEVELS);
    vec3 low_ls = vec3(1.0e30);
    vec3 high_ls = vec3(-1.0e30);
    for (uint i = 0u; i < 1u << (2u * above); ++i) {
        uint child = first + (i << (2u * u.below));
        if (child < used) {
            SampleNode node = nodes[tree + gn_tree_node(child % each, u.below, GN_LEVELS)];
            low_ls = min(low_ls, node.low_ls);
            high_ls = max(high_ls, node.high_ls);
        }
    }
    uint at = tree + gn_tree_node(first % each, level, GN_LEVELS);
    nodes[at] = SampleNode(low_ls, at + gn_tree_nodes(level), high_ls, 0u);
}
)";

constexpr std::uint32_t texels_summed = 128;  ///< texels that one invocation sums

void add_run_pass(const FrameInput& input, std::string name, const ShaderInputs& inputs, const std::string& includes,
                  const char* text, std::uint32_t count) {
    const auto shader = compute_once(input.prepared, name, hashed(inputs).text(includes),
                                     [&] { return includes + inputs.text() + text; });
    add_line_pass(input.graph, std::move(name), inputs, shader, count);
}

/// The length of every texel's list, and every sample's place in its own.
void add_counts(const FrameInput& input, const Recipe& recipe, const LightViews& views, const SortedSamples& sorted,
                BufferHandle cells, std::uint32_t bits) {
    add_zeros(input.graph, "view-samples: no lists", {cells});
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.buffer("buffer", "Cells", "uint cells[];", cells)
        .buffer("writeonly buffer", "Entries", "uvec2 entries[];", sorted.entries)
        .constant("uint", "cell_bits", bits);
    const std::string defines = receiver_defines(recipe, views);
    const std::string shared = sample_functions(input, recipe, views);
    const Hasher key = hashed(inputs).text(defines).text(shared).text(views.part->id);
    const auto shader = compute_once(input.prepared, "view-samples: lengths", key, [&] {
        return defines + include_line("shadow/view/view.glsl") + placement_text(*views.part, recipe) +
               include_line("shadow/direct/irregular_z/irregular_z.glsl") + inputs.text() + shared + count_text;
    });
    add_pixel_pass(input.graph, "view-samples: lengths", inputs, shader, input.samples.width, input.samples.height);
}

/// Lengths become places.
void add_running_sum(const FrameInput& input, const SortedSamples& sorted, BufferHandle cells, std::uint32_t runs) {
    const BufferHandle sums = input.graph.create(
        BufferDesc{.name = "view-samples sums", .bytes = VkDeviceSize{runs} * sizeof(std::uint32_t)});
    ShaderInputs inputs;
    inputs.buffer("buffer", "Cells", "uint cells[];", cells)
        .buffer("buffer", "Sums", "uint sums[];", sums)
        .constant("uint", "runs", runs);
    add_run_pass(input, "view-samples: sums", inputs, "", sums_text, runs);
    ShaderInputs whole = inputs;
    whole.buffer("buffer", "Used", "uint used;", sorted.used);
    add_run_pass(input, "view-samples: running sum", whole, "", starts_text, 1);
    add_run_pass(input, "view-samples: starts", inputs, "", cells_text, runs);
}

void add_tree(const FrameInput& input, const SortedSamples& sorted, BufferHandle cells, const glsl::GnLightAxes& axes) {
    const std::string includes = fmt::format("#define GN_LEVELS {}u\n", SortedSamples::tree_levels) +
                                 include_line("shadow/direct/view_samples/view_samples.glsl") +
                                 SortedSamples::node_type;
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.buffer("readonly buffer", "Cells", "uint cells[];", cells)
        .buffer("buffer", "Entries", "uvec2 entries[];", sorted.entries)
        .buffer("writeonly buffer", "Points", "uvec4 points[];", sorted.points)
        .buffer("buffer", "Nodes", "SampleNode nodes[];", sorted.nodes)
        .constant("uvec2", "size", uvec2(input.samples.width, input.samples.height))
        .constant("GnLightAxes", "axes", axes);
    const auto scatter = compute_once(input.prepared, "view-samples: lists", hashed(inputs),
                                      [&] { return includes + inputs.text() + scatter_text; });
    add_pixel_pass(input.graph, "view-samples: lists", inputs, scatter, input.samples.width, input.samples.height);

    const std::uint32_t places = sorted.trees << (2 * SortedSamples::tree_levels);
    for (std::uint32_t below = 0; below < SortedSamples::tree_levels; below += 3) {
        ShaderInputs boxes;
        boxes.buffer("buffer", "Nodes", "SampleNode nodes[];", sorted.nodes)
            .buffer("readonly buffer", "Used", "uint used;", sorted.used)
            .constant("uint", "below", below)
            .constant("uint", "places", places);
        const std::uint32_t lowest = places >> (2 * below);
        add_run_pass(input, "view-samples: boxes", boxes, includes, boxes_text,
                     (lowest >> 2) + (lowest >> 4) + (lowest >> 6));
    }
}

}  // namespace

SortedSamples add_sorted_samples(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                                 const glsl::GnLightAxes& axes) {
    static_assert(SortedSamples::tree_levels % 3 == 0, "boxes are made three levels at a time");
    SortedSamples sorted{.pixels = input.samples.width * input.samples.height};
    sorted.trees = (sorted.pixels + SortedSamples::tree_places - 1) / SortedSamples::tree_places;
    const auto create = [&](const char* name, VkDeviceSize count, VkDeviceSize bytes) {
        return input.graph.create(BufferDesc{.name = name, .bytes = count * bytes});
    };
    sorted.entries = create("view-samples entries", sorted.pixels, sizeof(uvec2));
    sorted.points = create("view-samples points", sorted.pixels, SortedSamples::point_bytes);
    sorted.nodes =
        create("view-samples nodes", VkDeviceSize{SortedSamples::tree_nodes} * sorted.trees, SortedSamples::node_bytes);
    sorted.used = create("view-samples used", 1, sizeof(std::uint32_t));

    const auto bits = static_cast<std::uint32_t>(std::bit_width(std::max(views.resolution, 1U) - 1));
    const std::uint32_t runs = ((views.layers << (2 * bits)) + texels_summed - 1) / texels_summed;
    const BufferHandle cells =
        create("view-samples lists", VkDeviceSize{runs} * texels_summed + 1, sizeof(std::uint32_t));
    add_counts(input, recipe, views, sorted, cells, bits);
    add_running_sum(input, sorted, cells, runs);
    add_tree(input, sorted, cells, axes);
    return sorted;
}

}  // namespace gn
