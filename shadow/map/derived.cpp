// SPDX-License-Identifier: MIT
// Based on: Decoret. N-Buffers for Efficient Depth Map Query. Computer Graphics Forum 2005. [Dec05]
#include "shadow/map/derived.h"

#include "shadow/recipe/part.h"

#include <algorithm>
#include <array>
#include <bit>

namespace gn {
namespace {

/// One fragment pass into one mip of one layer; `text` reads `source`, `push` (layer, stride) and gl_FragCoord.
struct Step {
    const char* name;
    std::string text;
    Range from, to;
    ivec2 push{0};  ///< layer within `from`, distance between the squares that are joined
};

void add_step(FrameGraph& graph, TextureHandle source, TextureHandle target, const Step& step) {
    static constexpr const char* head = R"(
layout(binding = 0) uniform sampler2DArray source;
layout(push_constant) uniform Push { int layer; int stride; } push;
layout(location = 0) out vec4 result;
)";
    graph.add_pass(
        step.name,
        [&](PassBuilder& pass) {
            pass.sample(source, step.from);
            pass.color(target, Load::discard, {}, step.to);
        },
        [source, step, desc = fullscreen({ShaderKind::fragment, step.name, head + step.text})](Recorder& r) {
            r.bind(desc);
            r.set("source", source, nearest(), step.from);
            r.push_value(step.push);
            r.draw(3);
        });
}

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

TextureHandle add_min_max_pyramid(FrameGraph& graph, TextureHandle depth) {
    TextureDesc desc = range_desc(graph, depth, "map min max");
    desc.mips = static_cast<std::uint32_t>(std::bit_width(std::max(desc.width, desc.height)));
    const TextureHandle pyramid = graph.create(desc);
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
        add_step(graph, depth, pyramid, {"min max", first_text, one_layer(layer), one_layer(layer)});
        for (std::uint32_t mip = 1; mip < desc.mips; ++mip) {
            add_step(graph, pyramid, pyramid,
                     {"min max", halve_text, one_layer(layer, mip - 1), one_layer(layer, mip)});
        }
    }
    return pyramid;
}

std::uint32_t n_buffer_levels(std::uint32_t side, std::uint32_t most_levels) {
    return std::min(static_cast<std::uint32_t>(std::bit_width(side)), most_levels);
}

TextureHandle add_n_buffer(FrameGraph& graph, TextureHandle source, NBuffer kind, std::uint32_t most_levels) {
    TextureDesc desc = range_desc(graph, source, "map n-buffer");
    if (kind == NBuffer::mean) {
        desc.format = graph.desc(source).format;
    }
    const std::uint32_t layers = desc.layers;
    const std::uint32_t levels = n_buffer_levels(std::max(desc.width, desc.height), most_levels);
    desc.layers = layers * levels;
    const TextureHandle buffer = graph.create(desc);
    const char* const first =
        kind == NBuffer::mean ? "void main() { result = texelFetch(source, ivec3(gl_FragCoord.xy, push.layer), 0); }\n"
                              : first_text;
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
        const std::uint32_t base = layer * levels;
        add_step(graph, source, buffer, {"n-buffer", first, one_layer(layer), one_layer(base)});
        for (std::uint32_t level = 1; level < levels; ++level) {
            add_step(graph, buffer, buffer,
                     {"n-buffer",
                      join_text(kind),
                      one_layer(base + level - 1),
                      one_layer(base + level),
                      {0, 1 << (level - 1)}});
        }
    }
    return buffer;
}

std::span<const Derivation> derivations() {
    static constexpr std::array<Derivation, 3> all{{
        {"min-max", "depth", "A pyramid of least and greatest depths.", add_min_max_pyramid},
        {"n-buffers", "depth", "Least and greatest depths of any square of 2^l texels.",
         [](FrameGraph& graph, TextureHandle depth) { return add_n_buffer(graph, depth, NBuffer::min_max); }},
        {"mean-n-buffers", "moments", "Means of any square of 2^l texels.",
         [](FrameGraph& graph, TextureHandle moments) { return add_n_buffer(graph, moments, NBuffer::mean); }},
    }};
    return all;
}

namespace {

const Derivation* derivation_of(std::string_view name) {
    const auto all = derivations();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Derivation& d) { return d.name == name; });
    return found != all.end() ? &*found : nullptr;
}

}  // namespace

bool map_gives(const Part& map, std::string_view need) {
    const Derivation* derived = derivation_of(need);
    return holds(map.gives, need) || (derived != nullptr && holds(map.gives, derived->from));
}

void add_derived(FrameGraph& graph, const Part& lookup, ShadowMap& map) {
    for (const std::string_view need : lookup.needs) {
        const Derivation* derived = derivation_of(need);
        const Offer* from = derived != nullptr ? map.find(derived->from) : nullptr;
        if (from != nullptr && map.find(need) == nullptr) {
            map.offers.push_back({std::string(need), derived->add(graph, from->texture), nearest()});
        }
    }
}

}  // namespace gn
