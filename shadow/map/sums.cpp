// SPDX-License-Identifier: MIT
// A summed-area table in two scans, along rows and then along columns.
//
// Based on: Lauritzen. Summed-Area Variance Shadow Maps. GPU Gems 3, 2007. [Lau07]
// Departs from it: compute shaders scan a line in one pass, one invocation a line or one workgroup a line.
#include "shadow/map/sums.h"

#include "gpu/shader_inputs.h"
#include "shadow/map/sums.glsl"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* head = R"(
#include "shadow/map/sums.glsl"
layout(push_constant) uniform Push { float levels; };
#ifdef GN_INTEGER
#define GN_SUM uvec2
#elif defined(GN_FOUR)
#define GN_SUM vec4
#define GN_TEXEL(sum) sum
#else
#define GN_SUM vec2
#define GN_TEXEL(sum) vec4(sum, 0.0, 0.0)
#endif
#ifdef GN_ROWS
GN_SUM load(int line, int i, int layer) {
    vec4 texel = texelFetch(source, ivec3(i, line, layer), 0);
#ifdef GN_INTEGER
    return gn_sat_quantize(texel.xy, levels);
#else
    return GN_SUM(texel - gn_sat_centre());
#endif
}
#ifdef GN_INTEGER
void store(int line, int i, int layer, GN_SUM sum) { imageStore(target, ivec3(i, line, layer), uvec4(sum, 0u, 0u)); }
#else
void store(int line, int i, int layer, GN_SUM sum) { imageStore(target, ivec3(i, line, layer), GN_TEXEL(sum)); }
#endif
#else
#ifdef GN_INTEGER
void store(int line, int i, int layer, GN_SUM sum) { imageStore(target, ivec3(line, i, layer), gn_sat_pack(sum)); }
#else
void store(int line, int i, int layer, GN_SUM sum) { imageStore(target, ivec3(line, i, layer), GN_TEXEL(sum)); }
#endif
GN_SUM load(int line, int i, int layer) { return GN_SUM(texelFetch(source, ivec3(line, i, layer), 0)); }
#endif
)";

// One invocation walks a line: least work, and what a CPU does best.
constexpr const char* serial = R"(
layout(local_size_x = 64) in;
void main() {
    int line = int(gl_GlobalInvocationID.x);
    int layer = int(gl_GlobalInvocationID.y);
    int count = imageSize(target).x;
    if (line >= count) {
        return;
    }
    GN_SUM sum = GN_SUM(0);
    for (int i = 0; i < count; ++i) {
        sum += load(line, i, layer);
        store(line, i, layer, sum);
    }
}
)";

// One workgroup walks a line in tiles, each scanned in shared memory by doubling strides.
constexpr const char* shared_memory = R"(
layout(local_size_x = 256) in;
shared GN_SUM tile[256];
void main() {
    int line = int(gl_WorkGroupID.x);
    int layer = int(gl_WorkGroupID.y);
    int count = imageSize(target).x;
    int lane = int(gl_LocalInvocationID.x);
    GN_SUM carry = GN_SUM(0);
    for (int start = 0; start < count; start += 256) {
        int i = start + lane;
        GN_SUM sum = i < count ? load(line, i, layer) : GN_SUM(0);
        tile[lane] = sum;
        barrier();
        for (int stride = 1; stride < 256; stride *= 2) {
            GN_SUM before = lane >= stride ? tile[lane - stride] : GN_SUM(0);
            barrier();
            sum += before;
            tile[lane] = sum;
            barrier();
        }
        if (i < count) {
            store(line, i, layer, carry + sum);
        }
        carry += tile[255];
        barrier();
    }
}
)";

struct Scan {
    bool rows = true, integer = false, four = false, in_shared_memory = false;
    [[nodiscard]] const char* name() const { return rows ? "sum rows" : "sum columns"; }
};

/// What a scan reads and writes, whole floats or integers, the first along rows.
ShaderInputs inputs_of(const FrameGraph& graph, TextureHandle source, TextureHandle target, const Scan& scan) {
    ShaderInputs inputs;
    inputs.texture(scan.integer && !scan.rows ? "usampler2DArray" : "sampler2DArray", "source", source, nearest());
    const VkFormat format = graph.desc(target).format;
    const bool integers = format == VK_FORMAT_R32G32_UINT;
    inputs.image(integers ? "rg32ui" : image_format(format), "writeonly", integers ? "uimage2DArray" : "image2DArray",
                 "target", target);
    return inputs;
}

ComputeDesc scan_shader(const Scan& scan, const ShaderInputs& inputs) {
    std::string text;
    text += scan.rows ? "#define GN_ROWS\n" : "";
    text += scan.integer ? "#define GN_INTEGER\n" : "";
    text += scan.four ? "#define GN_FOUR\n" : "";
    text += inputs.text();
    text += head;
    text += scan.in_shared_memory ? shared_memory : serial;
    return sealed(ComputeDesc{{ShaderKind::compute, scan.name(), text}, {}});
}

void add_scan(FrameGraph& graph, const PreparedRecipe* prepared, TextureHandle source, TextureHandle target,
              const Scan& scan, float levels) {
    const ShaderInputs inputs = inputs_of(graph, source, target, scan);
    const Hasher key =
        hashed(inputs).value(scan.rows).value(scan.integer).value(scan.four).value(scan.in_shared_memory);
    const auto shader = made_once(prepared, "sums", key.finish().low, [&] { return scan_shader(scan, inputs); });
    graph.add_pass(
        scan.name(),
        [&](PassBuilder& pass) {
            pass.sample(source, one_mip(0));
            pass.storage_write(target);
        },
        [source, shader, target, levels, lines_together = scan.in_shared_memory ? 1U : 64U](Recorder& r) {
            const TextureDesc& size = r.desc(target);
            r.bind(*shader);
            r.set("source", source, nearest(), one_mip(0));
            r.set_storage("target", target);
            r.push_value(levels);
            r.dispatch((size.width + lines_together - 1) / lines_together, size.layers);
        });
}

}  // namespace

TextureHandle add_sat(FrameGraph& graph, TextureHandle source, const SatTable& options,
                      const PreparedRecipe* prepared) {
    const bool integer = options.table == GN_SAT_UINT32;
    const bool in_shared_memory =
        options.scan == GN_SAT_SCAN_SHARED || (options.scan == GN_SAT_SCAN_AUTO && !graph.device().info().cpu);
    const float levels = glsl::gn_sat_levels(options.max_box);
    TextureDesc desc = graph.desc(source);
    GN_CHECK_EQ(desc.width, desc.height);
    const bool four = !integer && channels_of(desc.format) == 4;
    const VkFormat floats = four ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32G32_SFLOAT;

    desc.mips = 1;
    desc.usage = 0;
    desc.name = "map summed along rows";
    desc.format = integer ? VK_FORMAT_R32G32_UINT : floats;
    const TextureHandle rows = graph.create(desc);
    desc.name = "map summed";
    desc.format = integer ? VK_FORMAT_R16G16B16A16_UNORM : floats;
    const TextureHandle table = graph.create(desc);
    add_scan(graph, prepared, source, rows, {true, integer, four, in_shared_memory}, levels);
    add_scan(graph, prepared, rows, table, {false, integer, four, in_shared_memory}, levels);
    return table;
}

}  // namespace gn
