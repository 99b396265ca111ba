// SPDX-License-Identifier: MIT
// Depths as the casters leave them, and the layers warped from them in image space: the scene is drawn once, however many
// layers there are.
//
// Based on: Lauritzen, McCool. Layered Variance Shadow Maps. Graphics Interface 2008. [LM08]
#include "shadow/map/lvsm/lvsm_passes.h"
#include "shadow/map/prefilter.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* warp_text = R"(
layout(push_constant) uniform Push { int map_layer; int first; };
layout(location = 0) out vec4 out_moments;
vec2 moments(vec2 depth, int i) {
    // A layer beyond the last fills the second half of an odd number's texture; nobody reads it.
    int k = min(i, u.params.layers - 1);
    vec2 interval = gn_lvsm_interval(k, gn_lvsm_split(splits, map_layer, k, u.params),
                                     gn_lvsm_split(splits, map_layer, k + 1, u.params), u.params);
    return gn_lvsm_moments(depth.x, depth.y, interval);
}
void main() {
    ivec3 texel = ivec3(ivec2(gl_FragCoord.xy), map_layer);
    out_moments = vec4(0);
    for (int s = 0; s < GN_SAMPLES; ++s) {
        vec2 depth = texelFetch(depths, texel, s).xy;
        out_moments += vec4(moments(depth, first), moments(depth, first + 1)) / float(GN_SAMPLES);
    }
}
)";

struct WarpPush {
    int map_layer, first;
};

/// A single layer needs two components only.
VkFormat format_of(const GnLvsmParams& params) {
    switch (params.format) {
        case GN_LVSM_UNORM8: return params.layers == 1 ? VK_FORMAT_R8G8_UNORM : VK_FORMAT_R8G8B8A8_UNORM;
        case GN_LVSM_UNORM16: return params.layers == 1 ? VK_FORMAT_R16G16_UNORM : VK_FORMAT_R16G16B16A16_UNORM;
        default: return params.layers == 1 ? VK_FORMAT_R32G32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
    }
}

}  // namespace

TextureHandle add_depths(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                         const GnLvsmParams& params) {
    TextureDesc color{.name = "map depths",
                      .format = VK_FORMAT_R32G32_SFLOAT,
                      .width = views.resolution,
                      .height = views.resolution,
                      .layers = views.layers,
                      .samples = static_cast<std::uint32_t>(params.samples)};
    TextureDesc depth = color;
    depth.name = "map depth";
    depth.format = VK_FORMAT_D32_SFLOAT;

    // The spread of the texel's plane as in a variance map: [DL06] 4.1.
    CasterFragment fragment;
    fragment.includes = "#include \"shadow/map/vsm/vsm.glsl\"\nlayout(location = 0) out vec4 out_moments;\n";
    fragment.body = params.slope_moment != 0 ? "out_moments = vec4(depth, gn_vsm_spread(slope.x, slope.y), 0, 0);"
                                             : "out_moments = vec4(depth, 0, 0, 0);";
    fragment.reads_slope = params.slope_moment != 0;
    const TextureHandle target = input.graph.create(color);
    add_caster_passes(input, recipe, views,
                      {.color = target,
                       .clear_color = {.color = vec4(1, 0, 0, 0)},
                       .depth = input.graph.create(depth),
                       .fragment = fragment});
    return target;
}

TextureHandle add_warp(const FrameInput& input, TextureHandle depths, TextureHandle splits,
                       const GnLvsmParams& params) {
    const TextureDesc source = input.graph.desc(depths);
    const auto textures = static_cast<std::uint32_t>((params.layers + 1) / 2);
    TextureDesc desc{.name = "map",
                     .format = format_of(params),
                     .width = source.width,
                     .height = source.height,
                     .layers = source.layers * textures,
                     .mips = drawn_mips(params.prefilter, source.width)};
    const TextureHandle target = input.graph.create(desc);
    // Uniform splits are computed; what is bound then is not read.
    const TextureHandle bound_splits = splits.valid() ? splits : input.handles.white;
    ShaderInputs inputs;
    inputs.texture(source.samples > 1 ? "sampler2DMSArray" : "sampler2DArray", "depths", depths);
    inputs.texture("sampler2DArray", "splits", bound_splits).constant("GnLvsmParams", "params", params);
    const auto shader = made_once(input.prepared, "lvsm warp", hashed(inputs).value(source.samples).finish().low, [&] {
        return sealed(fullscreen({ShaderKind::fragment, "lvsm-warp.frag",
                                  fmt::format("#define GN_SAMPLES {}\n", source.samples) +
                                      include_line("shadow/map/lvsm/lvsm.glsl") + inputs.text() + warp_text}));
    });
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
        const WarpPush push{static_cast<int>(layer / textures), static_cast<int>(layer % textures) * 2};
        input.graph.add_pass(
            "lvsm: warp",
            [&](PassBuilder& pass) {
                inputs.declare(pass);
                pass.color(target, Load::discard, {}, one_layer(layer));
            },
            [=](Recorder& r) {
                r.bind(*shader);
                inputs.set(r);
                r.push_value(push);
                r.draw(3);
            });
    }
    return target;
}

}  // namespace gn
