// SPDX-License-Identifier: MIT
// Variance shadow maps: depth and its square in RG32F, filtered like any colour.
//
// Based on: Donnelly, Lauritzen. Variance Shadow Maps. I3D 2006. [DL06]
#include "shadow/map/vsm/vsm.h"

#include "shadow/map/derived.h"
#include "shadow/map/prefilter.h"

namespace gn::parts::vsm {
namespace {

ShadowMap add_vsm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnVsmParams>("vsm");

    // Rasterize moments; a texel without caster stores those of the far plane.
    MomentMap moments;
    moments.format = VK_FORMAT_R32G32_SFLOAT;
    moments.samples = params.samples;
    moments.clear = {.color = vec4(1, 1, 0, 0)};
    moments.mips = drawn_mips(params.prefilter, views.resolution);
    moments.fragment.includes = "#include \"shadow/map/vsm/vsm.glsl\"\nlayout(location = 0) out vec4 out_moments;\n";
    moments.fragment.body = params.slope_moment != 0
                                ? "out_moments = vec4(gn_vsm_moments(depth, gn_vsm_spread(slope.x, slope.y)), 0, 0);"
                                : "out_moments = vec4(gn_vsm_moments(depth, 0.0), 0, 0);";
    moments.fragment.reads_slope = params.slope_moment != 0;
    moments.depth = create_depth(input, views, moments);
    const TextureHandle raw = add_moments(input, recipe, views, moments);

    // Blur and mipmap.
    ShadowMap map = filtered_map(input, views, "moments", raw, params.prefilter);
    offer_ranges(input, recipe, moments.depth, map);
    if (params.squares != 0) {
        map.offers.push_back({"mean-n-buffers", add_n_buffer(input.graph, map.texture(), NBuffer::mean), linear()});
    }
    return map;
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    return blur_guard(recipe.of<GnVsmParams>("vsm").prefilter);
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    return refuse_samples("vsm.samples", recipe.of<GnVsmParams>("vsm").samples);
}

}  // namespace
}  // namespace gn::parts::vsm

namespace gn::parts {

const Part& map_vsm() {
    using namespace vsm;
    static const Part part = [] {
        Part p;
        p.id = "vsm";
        p.stage = Stage::map;
        p.title = "Variance shadow maps";
        p.citation = "DL06";
        p.filterable = true;
        p.gives = {"moments", "min-max"};
        p.textures = {"moments", "mean-n-buffers"};
        p.features = {Feature::float32_filter};
        p.params = param_table<GnVsmParams>(with_prefilter(
            {
                samples_row(offsetof(GnVsmParams, samples)),
                slope_moment_row(offsetof(GnVsmParams, slope_moment)),
                min_deviation_row(offsetof(GnVsmParams, min_deviation)),
                max_deviation_row(offsetof(GnVsmParams, max_deviation)),
                bleeding_row(offsetof(GnVsmParams, bleeding)),
                reduction_row(offsetof(GnVsmParams, reduction)),
                GN_PARAM(
                    GnVsmParams, squares, boolean, 0, 1, "",
                    "Reads means of squares of 2^l texels that begin anywhere (N-buffers) instead of mips: boxes and "
                    "no tents, for as many times the memory as the map has levels."),
            },
            offsetof(GnVsmParams, prefilter)));
        p.params_type = "GnVsmParams";
        p.glsl = "shadow/map/vsm/vsm.glsl";
        p.add_map = add_vsm;
        p.guard = guard;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
