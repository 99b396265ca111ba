// SPDX-License-Identifier: MIT
// Based on: Decoret. N-Buffers for Efficient Depth Map Query. Computer Graphics Forum 2005. [Dec05]
#include "shadow/map/derived.h"

#include "gpu/shader_inputs.h"
#include "shadow/receiver/map_range.glsl"

#include <algorithm>
#include <bit>

namespace gn {
namespace {

/// One fragment pass into one mip of one layer.
struct Step {
    const RasterDesc& shader;
    Range from, to;
    ivec2 push{0};  ///< layer within `from`, distance between the squares that are joined
};

void add_step(FrameGraph& graph, TextureHandle source, TextureHandle target, const Step& step) {
    graph.add_pass(
        step.shader.fragment->name,
        [&](PassBuilder& pass) {
            pass.sample(source, step.from);
            pass.color(target, Load::discard, {}, step.to);
        },
        [source, step](Recorder& r) {
            r.bind(step.shader);
            r.set("source", source, nearest(), step.from);
            r.push_value(step.push);
            r.draw(3);
        });
}

/// `text` reads `source`, `push` (layer, stride) and gl_FragCoord.
RasterDesc step_shader(const char* name, const std::string& text) {
    ShaderInputs inputs;
    inputs.texture("sampler2DArray", "source", {});
    return sealed(fullscreen({ShaderKind::fragment, name,
                              inputs.text() +
                                  "layout(push_constant) uniform Push { int layer; int stride; } push;\n"
                                  "layout(location = 0) out vec4 result;\n" +
                                  text}));
}

constexpr const char* copy_text =
    "void main() { result = texelFetch(source, ivec3(gl_FragCoord.xy, push.layer), 0); }\n";

constexpr const char* first_text = R"(
void main() {
    float depth = texelFetch(source, ivec3(ivec2(gl_FragCoord.xy), push.layer), 0).r;
    result = vec4(depth, depth, 0.0, 0.0);
}
)";

// The last texel of a level takes in what an odd side leaves over.
constexpr const char* halve_text = R"(
void main() {
    ivec2 size = textureSize(source, 0).xy;
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 first = 2 * texel;
    ivec2 last = min(first + 1, size - 1);
    ivec2 half_size = max(size / 2, ivec2(1));
    last = mix(last, size - 1, equal(texel, half_size - 1));
    vec2 range = vec2(3.0e38, -3.0e38);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            vec2 part = texelFetch(source, ivec3(x, y, push.layer), 0).xy;
            range = vec2(min(range.x, part.x), max(range.y, part.y));
        }
    }
    result = vec4(range, 0.0, 0.0);
}
)";

// Of a block of texels four at a time; the last one takes in what is left over, and beyond the map its border goes on.
constexpr const char* block_text = R"(
void main() {
    ivec2 size = textureSize(source, 0).xy;
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 first = texel * push.stride;
    ivec2 last = mix(first + push.stride - 1, size - 1, equal(texel, max(size / push.stride, ivec2(1)) - 1));
    vec4 least = vec4(3.0e38);
    vec4 greatest = vec4(-3.0e38);
    for (int y = first.y; y <= last.y; y += 2) {
        for (int x = first.x; x <= last.x; x += 2) {
            vec4 four = textureGather(source, vec3((vec2(x, y) + 1.0) / vec2(size), float(push.layer)));
            least = min(least, four);
            greatest = max(greatest, four);
        }
    }
    vec2 a = min(least.xy, least.zw);
    vec2 b = max(greatest.xy, greatest.zw);
    result = vec4(min(a.x, a.y), max(b.x, b.y), 0.0, 0.0);
}
)";

// Through the mean of what opposite sides of the block differ by, and before all of its depths, by what floats round besides.
const std::string lower_text = std::string("#include \"shadow/receiver/map_range.glsl\"\n") + R"(
void main() {
    ivec2 size = textureSize(source, 0).xy;
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 first = texel * push.stride;
    ivec2 last = mix(min(first + push.stride, size) - 1, size - 1, equal(texel, max(size / push.stride, ivec2(1)) - 1));
    float aa = texelFetch(source, ivec3(first, push.layer), 0).r;
    float ba = texelFetch(source, ivec3(last.x, first.y, push.layer), 0).r;
    float ab = texelFetch(source, ivec3(first.x, last.y, push.layer), 0).r;
    float bb = texelFetch(source, ivec3(last, push.layer), 0).r;
    vec2 extent = vec2(last - first);
    vec2 slope = 0.5 * vec2((ba - aa) + (bb - ab), (ab - aa) + (bb - ba)) / max(extent, vec2(1.0));
    vec4 least = vec4(3.0e38);
    for (int y = first.y; y <= last.y; y += 2) {
        for (int x = first.x; x <= last.x; x += 2) {
            vec4 four = textureGather(source, vec3((vec2(x, y) + 1.0) / vec2(size), float(push.layer)));
            // Where the map ends its border goes on.
            vec2 next = slope * vec2(min(ivec2(x, y) + 1, last) - ivec2(x, y));
            vec4 across = vec4(next.y, next.x + next.y, next.x, 0.0);
            least = min(least, four - across - dot(slope, vec2(ivec2(x, y) - first)));
        }
    }
    vec2 half_least = min(least.xy, least.zw);
    float depth = min(half_least.x, half_least.y);
    result = vec4(depth - exp2(-21.0) * (abs(depth) + dot(abs(slope), extent)), slope, 0.0);
}
)";

// The mean of the slopes of the blocks that one is made of, and before all of their planes.
const std::string join_lower_text = std::string("#include \"shadow/receiver/map_range.glsl\"\n") + R"(
void main() {
    ivec2 size = textureSize(source, 0).xy;
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 first = 2 * texel;
    ivec2 last = mix(min(first + 1, size - 1), size - 1, equal(texel, max(size / 2, ivec2(1)) - 1));
    vec2 slope = vec2(0.0);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            slope += texelFetch(source, ivec3(x, y, push.layer), 0).yz;
        }
    }
    slope /= float((last.x - first.x + 1) * (last.y - first.y + 1));
    float depth = 3.0e38;
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            vec3 block = texelFetch(source, ivec3(x, y, push.layer), 0).xyz;
            vec2 ahead = vec2((ivec2(x, y) - first) * push.stride);
            depth = min(depth, gn_lower_depth(block, ahead, gn_block_extent(ivec2(x, y), size - 1, push.stride), slope));
        }
    }
    result = vec4(depth - exp2(-21.0) * (abs(depth) + dot(abs(slope), vec2(4 * push.stride))), slope, 0.0);
}
)";

/// [Dec05]: a square of twice the side is four squares, each a side apart.
std::string join_text(NBuffer kind) {
    return R"(
void main() {
    ivec2 edge = textureSize(source, 0).xy - 1;
    ivec2 a = ivec2(gl_FragCoord.xy);
    ivec2 b = min(a + push.stride, edge);
    vec4 aa = texelFetch(source, ivec3(a, push.layer), 0);
    vec4 ba = texelFetch(source, ivec3(b.x, a.y, push.layer), 0);
    vec4 ab = texelFetch(source, ivec3(a.x, b.y, push.layer), 0);
    vec4 bb = texelFetch(source, ivec3(b, push.layer), 0);
)" + std::string(kind == NBuffer::mean ? "    result = 0.25 * ((aa + ba) + (ab + bb));\n}\n"
                                       : "    result = vec4(min(min(aa.x, ba.x), min(ab.x, bb.x)), "
                                         "max(max(aa.y, ba.y), max(ab.y, bb.y)), 0.0, 0.0);\n}\n");
}

/// The shaders of all steps, composed once.
struct StepShaders {
    RasterDesc range = step_shader("min max", first_text), halve = step_shader("min max", halve_text);
    RasterDesc block = step_shader("min max", block_text);
    RasterDesc lower = step_shader("lower planes", lower_text);
    RasterDesc join_lower = step_shader("lower planes", join_lower_text);
    RasterDesc square = step_shader("n-buffer", first_text), copy = step_shader("n-buffer", copy_text);
    RasterDesc join_ranges = step_shader("n-buffer", join_text(NBuffer::min_max));
    RasterDesc join_means = step_shader("n-buffer", join_text(NBuffer::mean));
    RasterDesc mipmapped = step_shader("mipmapped", copy_text);
};
const StepShaders& step_shaders() {
    static const StepShaders shaders;
    return shaders;
}

TextureDesc range_desc(FrameGraph& graph, TextureHandle source, std::string name) {
    TextureDesc desc = graph.desc(source);
    GN_CHECK_EQ(desc.samples, 1U);
    desc.name = std::move(name);
    desc.format = VK_FORMAT_R32G32_SFLOAT;
    desc.mips = 1;
    desc.usage = 0;
    return desc;
}

}  // namespace

TextureHandle add_min_max_pyramid(FrameGraph& graph, TextureHandle depth, std::uint32_t first) {
    TextureDesc desc = range_desc(graph, depth, "map min max");
    desc.width = std::max(desc.width >> first, 1U);
    desc.height = std::max(desc.height >> first, 1U);
    desc.mips = static_cast<std::uint32_t>(std::bit_width(std::max(desc.width, desc.height)));
    const TextureHandle pyramid = graph.create(desc);
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
        const RasterDesc& base = first > 0 ? step_shaders().block : step_shaders().range;
        add_step(graph, depth, pyramid, {base, one_layer(layer), one_layer(layer), {0, 1 << first}});
        for (std::uint32_t mip = 1; mip < desc.mips; ++mip) {
            add_step(graph, pyramid, pyramid, {step_shaders().halve, one_layer(layer, mip - 1), one_layer(layer, mip)});
        }
    }
    return pyramid;
}

TextureHandle add_lower_planes(FrameGraph& graph, TextureHandle depth) {
    TextureDesc desc = range_desc(graph, depth, "map lower planes");
    desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    desc.width = std::max(desc.width >> glsl::gn_coarse_mip, 1U);
    desc.height = std::max(desc.height >> glsl::gn_coarse_mip, 1U);
    desc.mips = static_cast<std::uint32_t>(std::bit_width(std::max(desc.width, desc.height)));
    const TextureHandle planes = graph.create(desc);
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
        int side = 1 << glsl::gn_coarse_mip;
        add_step(graph, depth, planes, {step_shaders().lower, one_layer(layer), one_layer(layer), {0, side}});
        for (std::uint32_t mip = 1; mip < desc.mips; ++mip, side *= 2) {
            add_step(graph, planes, planes,
                     {step_shaders().join_lower, one_layer(layer, mip - 1), one_layer(layer, mip), {0, side}});
        }
    }
    return planes;
}

std::uint32_t n_buffer_levels(std::uint32_t side, std::uint32_t most_levels) {
    return std::min(static_cast<std::uint32_t>(std::bit_width(side)), most_levels);
}

TextureHandle add_n_buffer(FrameGraph& graph, TextureHandle source, NBuffer kind, std::uint32_t most_levels,
                           std::uint32_t mip) {
    TextureDesc desc = range_desc(graph, source, "map n-buffer");
    if (kind == NBuffer::mean) {
        desc.format = graph.desc(source).format;
    }
    desc.width = std::max(desc.width >> mip, 1U);
    desc.height = std::max(desc.height >> mip, 1U);
    const std::uint32_t layers = desc.layers;
    const std::uint32_t levels = n_buffer_levels(std::max(desc.width, desc.height), most_levels);
    desc.layers = layers * levels;
    const TextureHandle buffer = graph.create(desc);
    const RasterDesc& first = kind == NBuffer::min_max ? step_shaders().square : step_shaders().copy;
    const RasterDesc& join = kind == NBuffer::mean ? step_shaders().join_means : step_shaders().join_ranges;
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
        const std::uint32_t base = layer * levels;
        add_step(graph, source, buffer, {first, one_layer(layer, mip), one_layer(base)});
        for (std::uint32_t level = 1; level < levels; ++level) {
            add_step(graph, buffer, buffer,
                     {join, one_layer(base + level - 1), one_layer(base + level), {0, 1 << (level - 1)}});
        }
    }
    return buffer;
}

void add_mips(FrameGraph& graph, TextureHandle texture) {
    const std::uint32_t mips = graph.desc(texture).mips;
    for (std::uint32_t mip = 1; mip < mips; ++mip) {
        graph.add_pass(
            "mip",
            [&](PassBuilder& pass) {
                pass.copy_from(texture, one_mip(mip - 1));
                pass.copy_to(texture, one_mip(mip));
            },
            [texture, mip](Recorder& r) {
                r.blit(texture, one_mip(mip - 1), texture, one_mip(mip), VK_FILTER_LINEAR);
            });
    }
}

TextureHandle add_mipmapped(FrameGraph& graph, TextureHandle source) {
    TextureDesc desc = graph.desc(source);
    GN_CHECK_EQ(desc.samples, 1U);
    desc.name = "map mipmapped";
    desc.format = is_depth(desc.format) ? VK_FORMAT_R32_SFLOAT : desc.format;
    desc.mips = static_cast<std::uint32_t>(std::bit_width(std::max(desc.width, desc.height)));
    desc.usage = 0;
    const TextureHandle copy = graph.create(desc);
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
        add_step(graph, source, copy, {step_shaders().mipmapped, one_layer(layer), one_layer(layer)});
    }
    add_mips(graph, copy);
    return copy;
}

}  // namespace gn
