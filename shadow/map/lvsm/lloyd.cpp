// SPDX-License-Identifier: MIT
// The splits of the layers, computed where the map is: a weighted histogram of second occluder depths, then Lloyd's
// relaxation by one workgroup a map layer.
//
// Based on: Lauritzen, McCool. Layered Variance Shadow Maps. Graphics Interface 2008. [LM08]
#include "gpu/shader_inputs.h"
#include "gpu/zeros_pass.h"
#include "shadow/frame/history.h"
#include "shadow/map/lvsm/lvsm_passes.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* histogram_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
float depth_at(ivec2 texel) { return texelFetch(depths, ivec3(texel, gl_GlobalInvocationID.z), 0).r; }
void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, textureSize(depths).xy - 1))) {
        return;
    }
    // Take the depths around a corner of four texels. Beside a texel without caster no receiver is behind anything.
    vec4 four = vec4(depth_at(texel), depth_at(texel + ivec2(1, 0)), depth_at(texel + ivec2(0, 1)),
                     depth_at(texel + ivec2(1, 1)));
    if (any(greaterThanEqual(four, vec4(1.0)))) {
        return;
    }
    // Add its weight, in units of 2^-22, to two words with a carry: integer sums do not depend on the order.
    vec2 second = gn_lloyd_sample(four);
    float share = gn_lloyd_weight(second.y, u.params.weight_least, u.params.weight_most);
    uint weight = uint(share * 4194304.0 + 0.5);
    if (weight == 0u) {
        return;
    }
    uint bin = gl_GlobalInvocationID.z * uint(GN_LVSM_BINS) +
               uint(clamp(int(second.x * float(GN_LVSM_BINS)), 0, GN_LVSM_BINS - 1));
    uint before = atomicAdd(bins[2u * bin], weight);
    if (before + weight < before) {
        atomicAdd(bins[2u * bin + 1u], 1u);
    }
}
)";

/// A multisampled map is judged by its first sample; textureSize has a level for the others only.
std::string histogram_head(std::uint32_t samples) {
    return std::string("#include \"shadow/map/lvsm/lloyd.glsl\"\n") +
           (samples > 1 ? "" : "#define textureSize(t) textureSize(t, 0)\n");
}

/// Counts the depths of every layer into its bins.
void add_histogram(const FrameInput& input, TextureHandle depths, BufferHandle bins, const GnLvsmParams& params) {
    const TextureDesc source = input.graph.desc(depths);
    add_zeros(input.graph, "lvsm: empty histogram", {bins});
    ShaderInputs inputs;
    inputs.texture(source.samples > 1 ? "sampler2DMSArray" : "sampler2DArray", "depths", depths);
    inputs.buffer("buffer", "Bins", "uint bins[];", bins).constant("GnLvsmParams", "params", params);
    const auto shader = compute_once(input.prepared, "lvsm-histogram.comp", hashed(inputs),
                                     [&] { return histogram_head(source.samples) + inputs.text() + histogram_text; });
    input.graph.add_pass(
        "lvsm: histogram", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, source](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch((source.width + 7) / 8, (source.height + 7) / 8, source.layers);
        });
}

/// Makes splits of the bins, from those of the frame before where there are any.
void add_relax(const FrameInput& input, BufferHandle bins, TextureHandle splits, TextureHandle before,
               std::uint32_t layers, const GnLvsmParams& params) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Bins", "uint bins[];", bins);
    inputs.image("r32f", "writeonly", "image2DArray", "splits", splits);
    if (before.valid()) {
        inputs.image("r32f", "readonly", "image2DArray", "splits_before", before);
    }
    inputs.constant("GnLvsmParams", "params", params);
    const auto shader = compute_once(input.prepared, "lvsm-relax.comp", hashed(inputs), [&] {
        return std::string(before.valid() ? "#define GN_BEFORE\n" : "") + "#include \"shadow/map/lvsm/lvsm.h\"\n" +
               inputs.text() + "#include \"shadow/map/lvsm/lloyd_relax.glsl\"\n";
    });
    input.graph.add_pass(
        "lvsm: relax", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, layers](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(layers, 1);
        });
}

}  // namespace

TextureHandle add_lloyd(const FrameInput& input, TextureHandle depths, const GnLvsmParams& params) {
    FrameGraph& graph = input.graph;
    const TextureDesc source = graph.desc(depths);

    // Keep the splits over frames where there is a sequence.
    TextureDesc desc{.name = fmt::format("lvsm splits {}", input.light_id),
                     .format = VK_FORMAT_R32_SFLOAT,
                     .width = static_cast<std::uint32_t>(params.layers) + 1,
                     .height = source.layers};
    TextureHandle splits;
    TextureHandle before;
    if (input.history != nullptr) {
        desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
        const History::Pair pair = input.history->pair(desc);
        splits = graph.import(*pair.now);
        before = pair.before != nullptr ? graph.import(*pair.before) : before;
    } else {
        splits = graph.create(desc);
    }
    const BufferHandle bins = graph.create(BufferDesc{
        .name = "lvsm histogram", .bytes = VkDeviceSize{source.layers} * GN_LVSM_BINS * 2 * sizeof(std::uint32_t)});

    add_histogram(input, depths, bins, params);
    add_relax(input, bins, splits, before, source.layers, params);
    return splits;
}

}  // namespace gn
