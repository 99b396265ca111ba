// SPDX-License-Identifier: MIT
// Convolution soft shadow maps: the waves of a convolution map, and the same waves times the depth.
//
// Based on: Annen, Dong, Mertens, Bekaert, Seidel, Kautz. Real-Time, All-Frequency Shadows in Dynamic Scenes. SIGGRAPH 2008.
// [ADM+08]
// Stands on: shadow/map/convolution (the series of the step)
#include "shadow/map/cssm/cssm.glsl"

#include "shadow/map/prefilter.h"

namespace gn::parts::cssm {
namespace {

/// Evaluates `groups` functions of four numbers of every texel of the depth map, and filters them.
Offer add_waves(const FrameInput& input, const LightViews& views, TextureHandle depth, const GnCssmParams& params,
                std::string_view name, int groups, const std::string& encode) {
    TextureDesc desc = input.graph.desc(depth);
    desc.name = name;
    desc.format = params.format == GN_CSSM_UNORM16 ? VK_FORMAT_R16G16B16A16_UNORM : VK_FORMAT_R8G8B8A8_UNORM;
    desc.layers *= static_cast<std::uint32_t>(groups);
    desc.mips = drawn_mips(params.prefilter, desc.width);
    desc.usage = 0;
    const TextureHandle waves = input.graph.create(desc);
    add_layer_passes(input, depth, waves,
                     {.name = std::string(name),
                      .includes = "#include \"shadow/map/cssm/cssm.glsl\"\n",
                      .text = "layout(location = 0) out vec4 out_waves;\n"
                              "void main() {\n    int groups = " +
                              std::to_string(groups) +
                              ";\n    int group = push_layer % groups;\n"
                              "    float depth = GN_SOURCE(ivec3(ivec2(gl_FragCoord.xy), push_layer / groups)).r;\n"
                              "    out_waves = " +
                              encode + ";\n}\n",
                      .inputs = ShaderInputs().constant("GnCssmParams", "params", params)});
    return filtered_map(input, views, name, waves, params.prefilter).offers.front();
}

ShadowMap add_cssm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnCssmParams>("cssm");

    // Rasterize depth and expand it twice.
    const TextureHandle depth = input.graph.create({.name = "map depth",
                                                    .format = VK_FORMAT_D32_SFLOAT,
                                                    .width = views.resolution,
                                                    .height = views.resolution,
                                                    .layers = views.layers});
    add_caster_passes(input, recipe, views, {.depth = depth});
    ShadowMap map;
    map.offers.push_back(add_waves(input, views, depth, params, "waves", glsl::gn_convolution_groups(params.terms),
                                   "gn_convolution_encode(depth, group, u.params.span)"));
    if (reads_ranges(recipe)) {
        map.offers.push_back(add_waves(input, views, depth, params, "depth-waves", glsl::gn_cssm_groups(params.terms),
                                       "gn_cssm_encode(depth, group, u.params.terms, u.params.span)"));
    }
    offer_ranges(input, recipe, depth, map);
    return map;
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    return blur_guard(recipe.of<GnCssmParams>("cssm").prefilter);
}

ParamTable rows() {
    return param_table<GnCssmParams>(with_prefilter(
        {
            GN_PARAM(GnCssmParams, terms, integer, 1, 16, "",
                     "Terms of both series: steeper steps and truer widths, four bytes a texel each in 8 bits."),
            GN_CHOICE(GnCssmParams, format,
                      "8 bits halve the memory, and round the depths of blockers that fill little of a kernel.",
                      "unorm8", "unorm16"),
            GN_PARAM(GnCssmParams, attenuation, real, 0, 8, "", "Damps the high terms: less ringing, flatter steps."),
            GN_PARAM(
                GnCssmParams, offset, real, 0, 4, "",
                "Moves the shadow's step towards the light, in half widths of it: less acne, more light at contacts."),
            GN_PARAM(GnCssmParams, search_offset, real, 0, 4, "",
                     "Likewise the search's: at 0 half of the receiver counts among its blockers, and penumbrae are "
                     "narrow."),
            GN_PARAM(GnCssmParams, span, real, 0.1, 1, "",
                     "Share of the half period that depth takes: finer steps, but at 1 the far end wraps into light."),
        },
        offsetof(GnCssmParams, prefilter)));
}

}  // namespace
}  // namespace gn::parts::cssm

namespace gn::parts {

const Part& map_cssm() {
    using namespace cssm;
    static const Part part = [] {
        Part p;
        p.id = "cssm";
        p.stage = Stage::map;
        p.title = "Convolution soft shadow maps";
        p.citation = "ADM+08";
        p.filterable = true;
        p.gives = {"waves", "depth-waves", "min-max"};
        p.textures = {"waves", "depth-waves"};
        p.params = rows();
        p.params_type = "GnCssmParams";
        p.glsl = "shadow/map/cssm/cssm.glsl";
        p.add_map = add_cssm;
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
