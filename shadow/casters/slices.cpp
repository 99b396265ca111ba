// SPDX-License-Identifier: MIT
// Based on: Eisemann, Decoret. Plausible Image Based Soft Shadows Using Occlusion Textures. SIBGRAPI 2006. [ED06]
// Departs from it: slices are bits of a number that fragments add to, and become textures afterwards.
#include "shadow/casters/slices.h"

#include "gpu/zeros_pass.h"
#include "shadow/casters/raster.h"

namespace gn {
namespace {

constexpr const char* add_text = R"(
    vec2 uv_ts = gl_FragCoord.xy / views[caster_view].resolution;
    float metres = gn_slices_metres(u.light, views[caster_view], uv_ts, depth);
    int slice = gn_slice_of(metres, u.slices, gn_slices_end(u.light, views[caster_view]));
    ivec3 texel = ivec3(gl_FragCoord.xy, views[caster_view].layer);
    atomicOr(slice_bits[(texel.z * u.side + texel.y) * u.side + texel.x], 1u << uint(slice));
    discard;
)";

constexpr const char* spread_text = R"(
layout(push_constant) uniform Push { int layer; int first; } push;
layout(location = 0) out vec4 result;
void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uint bits = slice_bits[(push.layer * u.side + texel.y) * u.side + texel.x] >> uint(push.first);
    result = vec4(float(bits & 1u), float(bits >> 1u & 1u), float(bits >> 2u & 1u), float(bits >> 3u & 1u));
}
)";

struct SlicePush {
    int layer, first;
};

/// A number for each texel, all 0.
BufferHandle add_no_bits(const FrameInput& input, const LightViews& views) {
    const VkDeviceSize texels = VkDeviceSize{views.resolution} * views.resolution * views.layers;
    const BufferHandle bits = input.graph.create({.name = "slice bits", .bytes = texels * sizeof(std::uint32_t)});
    add_zeros(input.graph, "slices: empty", {bits});
    return bits;
}

}  // namespace

TextureHandle add_slices(const FrameInput& input, const Recipe& recipe, const LightViews& views, int count) {
    GN_CHECK(count >= 1 && count <= most_slices);
    if (input.handles.drawn != nullptr) {
        refuse(
            "lookup '{}' sorts fragments of casters into slices, which a renderer that draws its casters itself "
            "cannot; "
            "lend their buffers",
            recipe.lookup->id);
    }
    // A fragment knows its layer where views are drawn one by one, and nothing of it is kept over frames.
    LightViews drawn = views;
    drawn.layered = false;
    drawn.kept.reset();
    const int side = static_cast<int>(views.resolution);
    const BufferHandle bits = add_no_bits(input, views);
    CasterPass pass;
    pass.name = "slices";
    pass.depth = input.graph.create({.name = "slices depth",
                                     .format = VK_FORMAT_D32_SFLOAT,
                                     .width = views.resolution,
                                     .height = views.resolution,
                                     .layers = views.layers});
    pass.fragment.includes = "#include \"shadow/receiver/slices.glsl\"\n";
    pass.fragment.inputs.buffer("buffer", "SliceBits", "uint slice_bits[];", bits)
        .constant("GnLight", "light", input.light().shape)
        .constant("int", "slices", count)
        .constant("int", "side", side);
    pass.fragment.body = add_text;
    add_caster_passes(input, recipe, drawn, pass);

    // Four slices a layer.
    const auto groups = static_cast<std::uint32_t>(count + 3) / 4;
    const TextureHandle slices = input.graph.create({.name = "map slices",
                                                     .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                                     .width = views.resolution,
                                                     .height = views.resolution,
                                                     .layers = views.layers * groups});
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "SliceBits", "uint slice_bits[];", bits).constant("int", "side", side);
    static const RasterDesc shader =
        sealed(fullscreen({ShaderKind::fragment, "slices: spread", inputs.text() + spread_text}));
    for (std::uint32_t i = 0; i < views.layers * groups; ++i) {
        input.graph.add_pass(
            "slices: spread",
            [&](PassBuilder& builder) {
                builder.color(slices, Load::discard, {}, one_layer(i));
                inputs.declare(builder);
            },
            [inputs, i, groups](Recorder& r) {
                r.bind(shader);
                inputs.set(r);
                r.push_value(SlicePush{static_cast<int>(i / groups), static_cast<int>(i % groups) * 4});
                r.draw(3);
            });
    }
    return slices;
}

}  // namespace gn
