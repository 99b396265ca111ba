// SPDX-License-Identifier: MIT
// Based on: Kirsch, Doellner. Real-Time Soft Shadows Using a Single Light Sample. WSCG 2003. [KD03]
// Departs from it: what ends a blocked region is a step of depth and not a mask of casters, since what receives shadows casts too,
// and it is found by halved jumps. [RT06]
#include "shadow/map/steps.h"

#include "gpu/shader_inputs.h"

namespace gn {
namespace {

constexpr const char* begin_text = R"(
const vec2 nowhere = vec2(1.0e4);
float depth_at(ivec2 texel) {
    ivec2 last = textureSize(source, 0).xy - 1;
    return texelFetch(source, ivec3(clamp(texel, ivec2(0), last), push.layer), 0).r;
}
// The least step, as a share of the depth range.
const float least = 1.0e-4;
void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float own = depth_at(texel);
    bool behind = false;
    for (int i = 0; i < 9; ++i) {
        ivec2 way = ivec2(i % 3, i / 3) - 1;
        float before = depth_at(texel + way);
        float slope = abs(before - depth_at(texel + 2 * way));
        behind = behind || own - before > 4.0 * slope + least;
    }
    result = vec4(behind ? vec2(0.0) : nowhere, 0.0, 0.0);
}
)";

constexpr const char* grow_text = R"(
void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(source, 0).xy - 1;
    vec2 found = texelFetch(source, ivec3(texel, push.layer), 0).xy;
    for (int i = 0; i < 9; ++i) {
        ivec2 way = push.stride * (ivec2(i % 3, i / 3) - 1);
        ivec2 beside = texel + way;
        if (any(lessThan(beside, ivec2(0))) || any(greaterThan(beside, last))) {
            continue;
        }
        vec2 theirs = texelFetch(source, ivec3(beside, push.layer), 0).xy;
        vec2 candidate = theirs.x < 5.0e3 ? theirs + vec2(way) : theirs;
        found = dot(candidate, candidate) < dot(found, found) ? candidate : found;
    }
    result = vec4(found, 0.0, 0.0);
}
)";

struct StepPush {
    int layer, stride;
};

RasterDesc shader_of(const char* text) {
    return sealed(fullscreen({ShaderKind::fragment, "steps",
                              ShaderInputs().texture("sampler2DArray", "source", {}).text() +
                                  "layout(push_constant) uniform Push { int layer; int stride; } push;\n"
                                  "layout(location = 0) out vec4 result;\n" +
                                  text}));
}

void add_layers(FrameGraph& graph, TextureHandle source, TextureHandle target, const RasterDesc& shader, int stride) {
    for (std::uint32_t layer = 0; layer < graph.desc(target).layers; ++layer) {
        graph.add_pass(
            "steps",
            [&](PassBuilder& pass) {
                pass.sample(source, one_layer(layer));
                pass.color(target, Load::discard, {}, one_layer(layer));
            },
            [source, &shader, layer, stride](Recorder& r) {
                r.bind(shader);
                r.set("source", source, nearest(), one_layer(layer));
                r.push_value(StepPush{0, stride});
                r.draw(3);
            });
    }
}

}  // namespace

TextureHandle add_steps(FrameGraph& graph, TextureHandle depth, int radius) {
    static const RasterDesc begin = shader_of(begin_text);
    static const RasterDesc grow = shader_of(grow_text);
    TextureDesc desc = graph.desc(depth);
    desc.name = "map steps";
    desc.format = VK_FORMAT_R16G16_SFLOAT;
    desc.mips = 1;
    desc.usage = 0;
    TextureHandle steps = graph.create(desc);
    add_layers(graph, depth, steps, begin, 0);
    int stride = 1;
    while (2 * stride <= radius) {
        stride *= 2;
    }
    for (; stride >= 1; stride /= 2) {
        const TextureHandle grown = graph.create(desc);
        add_layers(graph, steps, grown, grow, stride);
        steps = grown;
    }
    return steps;
}

}  // namespace gn
