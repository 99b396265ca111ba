// SPDX-License-Identifier: MIT
// Based on: Everitt. Interactive Order-Independent Transparency. NVIDIA 2001. [Eve01]
#include "shadow/casters/peel.h"

#include "shadow/casters/raster.h"

namespace gn {
namespace {

TextureHandle create_layer(const FrameInput& input, const LightViews& views, const char* name) {
    return input.graph.create({.name = name,
                               .format = VK_FORMAT_D32_SFLOAT,
                               .width = views.resolution,
                               .height = views.resolution,
                               .layers = views.layers});
}

/// The nearest surface of all casters, both sides.
TextureHandle add_first_layer(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    Recipe all = recipe;
    all.casters = Casters::all;
    const CasterPass pass{.name = "peel", .depth = create_layer(input, views, "peeled layer"), .every_side = true};
    add_caster_passes(input, all, views, pass);
    return pass.depth;
}

void add_copy(const FrameInput& input, TextureHandle from, std::uint32_t layer, TextureHandle to,
              std::uint32_t to_layer) {
    input.graph.add_pass(
        "peel: gather",
        [&](PassBuilder& builder) {
            builder.sample(from, one_layer(layer));
            builder.color(to, Load::discard, {}, one_layer(to_layer));
        },
        [=](Recorder& r) {
            static const std::string inputs = ShaderInputs().texture("sampler2DArray", "from", {}).text();
            static const RasterDesc shader = sealed(fullscreen({ShaderKind::fragment, "peel: gather", inputs + R"(
layout(location = 0) out vec4 depth;
void main() { depth = vec4(texelFetch(from, ivec3(gl_FragCoord.xy, 0), 0).r); }
)"}));
            r.bind(shader);
            r.set("from", from, nearest(), one_layer(layer));
            r.draw(3);
        });
}

}  // namespace

TextureHandle add_next_layer(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                             TextureHandle previous) {
    // A fragment knows its layer where views are drawn one by one, and what is kept over frames is another surface.
    LightViews drawn = views;
    drawn.layered = false;
    drawn.kept.reset();
    Recipe all = recipe;
    all.casters = Casters::all;
    CasterPass pass;
    pass.name = "map second";
    pass.every_side = true;
    pass.depth = create_layer(input, views, "map second");
    pass.fragment.includes = "#include \"shadow/receiver/receiver.glsl\"\n";
    pass.fragment.inputs.texture("sampler2DArray", "previous_depth", previous);
    pass.fragment.body = R"(
#ifdef GN_WRITE_DEPTH
    float own = depth;
#else
    float own = clamp(gl_FragCoord.z, 0.0, 1.0);
#endif
    if (own <= texelFetch(previous_depth, ivec3(gl_FragCoord.xy, views[caster_view].layer), 0).r + gn_depth_epsilon) {
        discard;
    }
)";
    add_caster_passes(input, all, drawn, pass);
    return pass.depth;
}

TextureHandle add_peeled(const FrameInput& input, const Recipe& recipe, const LightViews& views, int count) {
    GN_CHECK(count >= 1 && count <= most_peeled);
    LightViews drawn = views;
    drawn.kept.reset();
    const auto layers = static_cast<std::uint32_t>(count);
    const TextureHandle gathered = input.graph.create({.name = "map peeled",
                                                       .format = VK_FORMAT_R32_SFLOAT,
                                                       .width = views.resolution,
                                                       .height = views.resolution,
                                                       .layers = views.layers * layers});
    TextureHandle layer = add_first_layer(input, recipe, drawn);
    for (std::uint32_t i = 0; i < layers; ++i) {
        for (std::uint32_t view = 0; view < views.layers; ++view) {
            add_copy(input, layer, view, gathered, view * layers + i);
        }
        layer = i + 1 < layers ? add_next_layer(input, recipe, drawn, layer) : layer;
    }
    return gathered;
}

}  // namespace gn
