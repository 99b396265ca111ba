// SPDX-License-Identifier: MIT
// Variance shadow maps: depth and its square in RG32F, filtered like any colour.
//
// Based on: Donnelly, Lauritzen. Variance Shadow Maps. I3D 2006. [DL06]
#include "shadow/map/vsm/vsm.h"

#include "shadow/map/prefilter.h"

namespace gn {
namespace {

ShadowMap add_vsm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnVsmParams>("vsm");
    const std::uint32_t mips = params.mipmaps != 0 ? full_chain(views.resolution) : 1;

    // Rasterize moments; a texel without caster stores those of the far plane.
    MomentMap moments;
    moments.format = VK_FORMAT_R32G32_SFLOAT;
    moments.samples = params.samples;
    moments.clear = {.color = vec4(1, 1, 0, 0)};
    moments.mips = mips;
    moments.fragment.includes = "#include \"shadow/map/vsm/vsm.glsl\"\nlayout(location = 0) out vec4 out_moments;\n";
    moments.fragment.body = params.slope_moment != 0
                                ? "out_moments = vec4(gn_vsm_moments(depth, dFdx(in_depth), dFdy(in_depth)), 0, 0);"
                                : "out_moments = vec4(gn_vsm_moments(depth, 0.0, 0.0), 0, 0);";
    const TextureHandle raw = add_moments(input, recipe, views, moments);

    // Blur and mipmap.
    return filtered_map(input, raw, static_cast<BlurKernel>(params.blur), params.radius, mips, params.anisotropy);
}

Guard guard(const Recipe& recipe) {
    const auto params = recipe.of<GnVsmParams>("vsm");
    return blur_guard(static_cast<BlurKernel>(params.blur), params.radius);
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    return refuse_samples("vsm.samples", recipe.of<GnVsmParams>("vsm").samples);
}

}  // namespace

namespace parts {

const Part& map_vsm() {
    static const Part part = [] {
        Part p;
        p.id = "vsm";
        p.stage = Stage::map;
        p.title = "Variance shadow maps";
        p.citation = "DL06";
        p.gives = "filterable";
        p.params = param_table<GnVsmParams>({
            GN_PARAM(GnVsmParams, samples, integer, 1, 4, "",
                     "Samples a texel, 1 or 4: smoother edges, four times the memory while drawing."),
            GN_CHOICE(GnVsmParams, blur, "The kernel that the map is blurred with.", "none", "box", "gaussian"),
            GN_PARAM(GnVsmParams, radius, integer, 0, 64, "texels",
                     "Reach of the blur: softer edges and more bleeding, cost grows in proportion."),
            GN_PARAM(GnVsmParams, mipmaps, boolean, 0, 1, "", "Smooths distant shadows; a third more memory."),
            GN_PARAM(GnVsmParams, anisotropy, integer, 1, 16, "",
                     "Fetches along stretched footprints: sharper at grazing views, slow in software."),
            GN_PARAM(GnVsmParams, slope_moment, boolean, 0, 1, "",
                     "Adds the slope of the surface to the second moment: no acne on slanted surfaces."),
            GN_PARAM(GnVsmParams, min_deviation, real, 0, 1, "m",
                     "Least standard deviation assumed: less acne, softer contacts."),
            GN_PARAM(GnVsmParams, bleeding, real, 0, 0.99, "",
                     "Share of the bound cut off: less bleeding, darker and harder penumbrae."),
        });
        p.params_type = "GnVsmParams";
        p.glsl = "shadow/map/vsm/vsm.glsl";
        p.add_map = add_vsm;
        p.guard = guard;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace parts
}  // namespace gn
