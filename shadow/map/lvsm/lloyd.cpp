// SPDX-License-Identifier: MIT
// The splits of the layers, computed where the map is: a weighted histogram of second occluder depths, then Lloyd's
// relaxation by one workgroup a map layer.
//
// Based on: Lauritzen, McCool. Layered Variance Shadow Maps. Graphics Interface 2008. [LM08]
#include "shadow/frame/history.h"
#include "shadow/map/lvsm/lvsm_passes.h"

namespace gn {
namespace {

constexpr const char* histogram_text = R"(
#define GN_LLOYD_BEFORE(i) vec3(0)
#include "shadow/map/lvsm/lloyd.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform GN_DEPTHS depths;
layout(binding = 1, scalar) buffer Bins { uint bins[]; };
layout(binding = 2, scalar) uniform Params { GnLvsmParams params; } u;
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

constexpr const char* relax_text = R"(
#include "shadow/map/lvsm/lvsm.h"
shared vec3 prefix[GN_LVSM_BINS + 1];
#define GN_LLOYD_BEFORE(i) prefix[i]
#include "shadow/map/lvsm/lloyd.glsl"
#define THREADS 128
#define RUN (GN_LVSM_BINS / THREADS)
layout(local_size_x = THREADS) in;
layout(binding = 0, scalar) readonly buffer Bins { uint bins[]; };
layout(binding = 1, r32f) uniform writeonly image2DArray splits;
layout(binding = 2, scalar) uniform Lloyd { GnLvsmParams params; } u;
#ifdef GN_BEFORE
layout(binding = 3, r32f) uniform readonly image2DArray splits_before;
#endif
shared vec3 runs[THREADS];
void main() {
    int row = int(gl_WorkGroupID.x);
    int thread = int(gl_LocalInvocationIndex);

    // Sum each thread's run of bins.
    vec3 sum = vec3(0);
    for (int i = thread * RUN; i < (thread + 1) * RUN; ++i) {
        uint bin = uint(row * GN_LVSM_BINS + i);
        float weight = float(bins[2u * bin]) + 4294967296.0 * float(bins[2u * bin + 1u]);
        float x = (float(i) + 0.5) / float(GN_LVSM_BINS) - 0.5;
        prefix[i] = sum;
        sum += weight * vec3(1.0, x, x * x);
    }
    // Scan the runs.
    runs[thread] = sum;
    for (int stride = 1; stride < THREADS; stride *= 2) {
        barrier();
        vec3 other = thread >= stride ? runs[thread - stride] : vec3(0);
        barrier();
        runs[thread] += other;
    }
    barrier();
    for (int i = thread * RUN; i < (thread + 1) * RUN; ++i) {
        prefix[i] += thread > 0 ? runs[thread - 1] : vec3(0);
    }
    if (thread == THREADS - 1) {
        prefix[GN_LVSM_BINS] = runs[thread];
    }
    barrier();
    if (thread != 0) {
        return;
    }
    // Relax from where the frame before left the splits.
    GnLloydSplits s = gn_lloyd_uniform(u.params.layers);
#ifdef GN_BEFORE
    for (int k = 1; k < u.params.layers; ++k) {
        s.at[k] = imageLoad(splits_before, ivec3(k, row, 0)).r;
    }
#endif
    if (prefix[GN_LVSM_BINS].x > 0.0) {
        for (int i = 0; i < u.params.iterations; ++i) {
            s = gn_lloyd_iterate(s, u.params.layers);
        }
    }
    for (int k = 0; k <= u.params.layers; ++k) {
        imageStore(splits, ivec3(k, row, 0), vec4(s.at[k]));
    }
}
)";

std::string histogram_for(std::uint32_t samples) {
    // A multisampled map is judged by its first sample; textureSize has a level for the others only.
    return samples > 1 ? std::string("#define GN_DEPTHS sampler2DMSArray\n") + histogram_text
                       : "#define GN_DEPTHS sampler2DArray\n#define textureSize(t) textureSize(t, 0)\n" +
                             std::string(histogram_text);
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

    graph.add_pass(
        "lvsm: empty histogram", [&](PassBuilder& pass) { pass.copy_to(bins); },
        [bins](Recorder& r) { r.fill(bins, 0); });
    graph.add_pass(
        "lvsm: histogram",
        [&](PassBuilder& pass) {
            pass.sample(depths);
            pass.storage_write(bins);
        },
        [=, text = histogram_for(source.samples)](Recorder& r) {
            r.bind(ComputeDesc{.shader = {ShaderKind::compute, "lvsm-histogram.comp", text}});
            r.set("depths", depths);
            r.set("Bins", bins);
            r.set_value("u", params);
            r.dispatch((source.width + 7) / 8, (source.height + 7) / 8, source.layers);
        });
    graph.add_pass(
        "lvsm: relax",
        [&](PassBuilder& pass) {
            pass.storage_read(bins);
            pass.storage_write(splits);
            if (before.valid()) {
                pass.storage_read(before);
            }
        },
        [=, layers = source.layers](Recorder& r) {
            static const std::array<ComputeDesc, 2> shaders{
                sealed({.shader = {ShaderKind::compute, "lvsm-relax.comp", relax_text}}),
                sealed({.shader = {ShaderKind::compute, "lvsm-relax.comp",
                                   std::string("#define GN_BEFORE\n") + relax_text}})};
            r.bind(shaders[before.valid() ? 1 : 0]);
            if (before.valid()) {
                r.set_storage("splits_before", before);
            }
            r.set("Bins", bins);
            r.set_storage("splits", splits);
            r.set_value("u", params);
            r.dispatch(layers, 1);
        });
    return splits;
}

}  // namespace gn
