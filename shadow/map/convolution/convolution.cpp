// SPDX-License-Identifier: MIT
// Convolution shadow maps: a Fourier basis of depth in 8-bit textures, two terms a texture, the textures of a view in
// successive layers.
//
// Based on: Annen, Mertens, Bekaert, Seidel, Kautz. Convolution Shadow Maps. EGSR 2007. [AMB+07]
#include "shadow/map/convolution/convolution.glsl"

#include "shadow/map/prefilter.h"

namespace gn::parts::convolution {
namespace {

/// Evaluates the basis functions of every texel of the depth map.
TextureHandle add_basis(const FrameInput& input, const LightViews& views, TextureHandle depth,
                        const GnConvolutionParams& params) {
    TextureDesc desc = input.graph.desc(depth);
    desc.name = "map";
    desc.format = VK_FORMAT_R8G8B8A8_UNORM;
    desc.layers *= static_cast<std::uint32_t>(glsl::gn_convolution_groups(params.terms));
    desc.mips = drawn_mips(params.prefilter, desc.width);
    desc.usage = 0;
    const TextureHandle basis = input.graph.create(desc);
    add_layer_passes(input, depth, basis,
                     {.name = "basis",
                      .includes = "#include \"shadow/map/convolution/convolution.glsl\"\n",
                      .text = R"(
layout(location = 0) out vec4 out_basis;
void main() {
    int groups = gn_convolution_groups(u.params.terms);
    float depth = GN_SOURCE(ivec3(ivec2(gl_FragCoord.xy), push_layer / groups)).r;
    out_basis = gn_convolution_encode(depth, push_layer % groups, u.params.span);
}
)",
                      .inputs = ShaderInputs().constant("GnConvolutionParams", "params", params),
                      .tiles = views.tiles ? nullptr : &views});
    return basis;
}

ShadowMap add_convolution(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnConvolutionParams>("convolution");

    // Rasterize depth and expand it.
    const TextureHandle depth = input.graph.create({.name = "map depth",
                                                    .format = VK_FORMAT_D32_SFLOAT,
                                                    .width = views.resolution,
                                                    .height = views.resolution,
                                                    .layers = views.layers});
    add_caster_passes(input, recipe, views, {.depth = depth});
    const TextureHandle basis = add_basis(input, views, depth, params);

    // Blur and mipmap.
    return filtered_map(input, views, "waves", basis, params.prefilter);
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    return blur_guard(recipe.of<GnConvolutionParams>("convolution").prefilter);
}

ParamTable rows() {
    return param_table<GnConvolutionParams>(with_prefilter(
        {
            GN_PARAM(GnConvolutionParams, terms, integer, 1, 16, "",
                     "Terms of the series: steeper steps and less bleeding, two bytes a texel each."),
            GN_PARAM(GnConvolutionParams, attenuation, real, 0, 8, "",
                     "Damps the high terms: less ringing, flatter steps."),
            GN_PARAM(GnConvolutionParams, offset, real, 0, 2, "",
                     "Moves the step into the shadow, in half widths of it: less acne, more light at contacts."),
            GN_PARAM(GnConvolutionParams, scale, real, 1, 8, "",
                     "Multiplies the value, which is clamped to 1: at 2 no surface shades itself, and penumbrae reach "
                     "less far out."),
            GN_PARAM(GnConvolutionParams, span, real, 0.1, 1, "",
                     "Share of the half period that depth takes: finer steps, but at 1 the far end wraps into light."),
        },
        offsetof(GnConvolutionParams, prefilter)));
}

}  // namespace
}  // namespace gn::parts::convolution

namespace gn::parts {

const Part& map_convolution() {
    using namespace convolution;
    static const Part part = [] {
        Part p;
        p.id = "convolution";
        p.stage = Stage::map;
        p.title = "Convolution shadow maps";
        p.citation = "AMB+07";
        p.filterable = true;
        p.gives = {"waves"};
        p.textures = {"waves"};
        p.params = rows();
        p.params_type = "GnConvolutionParams";
        p.glsl = "shadow/map/convolution/convolution.glsl";
        p.add_map = add_convolution;
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
