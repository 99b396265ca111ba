// SPDX-License-Identifier: MIT
// Summed-area variance shadow maps: one table answers boxes of every size and shape at the same cost.
//
// Based on: Lauritzen. Summed-Area Variance Shadow Maps. GPU Gems 3, 2007. [Lau07]
// Stands on: shadow/map/vsm (moments, Chebyshev's bound and the reduction of bleeding)
#include "shadow/map/sat_vsm/sat_vsm.h"

#include "shadow/map/prefilter.h"
#include "shadow/map/sums.h"

namespace gn::parts::sat_vsm {
namespace {

ShadowMap add_sat_vsm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnSatVsmParams>("sat-vsm");

    // Rasterize moments; a texel without caster stores those of the far plane.
    MomentMap moments;
    moments.name = "map moments";
    moments.format = VK_FORMAT_R32G32_SFLOAT;
    moments.samples = params.samples;
    moments.clear = {.color = vec4(1, 1, 0, 0)};
    moments.fragment.includes = "#include \"shadow/map/vsm/vsm.glsl\"\nlayout(location = 0) out vec4 out_moments;\n";
    moments.fragment.body = params.slope_moment != 0
                                ? "out_moments = vec4(gn_vsm_moments(depth, gn_vsm_spread(slope.x, slope.y)), 0, 0);"
                                : "out_moments = vec4(gn_vsm_moments(depth, 0.0), 0, 0);";
    moments.fragment.reads_slope = params.slope_moment != 0;
    moments.depth = create_depth(input, views, moments);
    const TextureHandle raw = add_moments(input, recipe, views, moments);

    // Sum.
    const TextureHandle sums = add_sat(
        input.graph, raw, {.table = params.table, .scan = params.scan, .max_box = params.max_box}, input.prepared);
    ShadowMap map{.offers = {{"sums", sums, nearest()}}};
    offer_ranges(input, recipe, moments.depth, map);
    return map;
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    return {.texels = recipe.of<GnSatVsmParams>("sat-vsm").radius};
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    return refuse_samples("sat-vsm.samples", recipe.of<GnSatVsmParams>("sat-vsm").samples);
}

ParamTable rows() {
    return param_table<GnSatVsmParams>({
        GN_CHOICE(GnSatVsmParams, table,
                  "Floats lose precision with the map's area; integers are exact up to boxes of sat-vsm.max_box.",
                  "float32", "uint32"),
        GN_CHOICE(GnSatVsmParams, scan, "How lines are summed: one invocation each, or one workgroup each.", "auto",
                  "serial", "shared"),
        GN_PARAM(GnSatVsmParams, max_box, integer, 8, 512, "texels",
                 "Side of the largest box: steadier far shadows, but integers are left with coarser moments."),
        GN_PARAM(GnSatVsmParams, radius, real, 0, 128, "texels",
                 "Half the least box beyond the receiver's texel: softer edges and more bleeding at no cost."),
        samples_row(offsetof(GnSatVsmParams, samples)),
        slope_moment_row(offsetof(GnSatVsmParams, slope_moment)),
        min_deviation_row(offsetof(GnSatVsmParams, min_deviation)),
        max_deviation_row(offsetof(GnSatVsmParams, max_deviation)),
        bleeding_row(offsetof(GnSatVsmParams, bleeding)),
        reduction_row(offsetof(GnSatVsmParams, reduction)),
    });
}

}  // namespace
}  // namespace gn::parts::sat_vsm

namespace gn::parts {

const Part& map_sat_vsm() {
    using namespace sat_vsm;
    static const Part part = [] {
        Part p;
        p.id = "sat-vsm";
        p.stage = Stage::map;
        p.title = "Summed-area variance shadow maps";
        p.citation = "Lau07";
        p.filterable = true;
        p.gives = {"sums", "min-max"};
        p.textures = {"sums"};
        p.params = rows();
        p.params_type = "GnSatVsmParams";
        p.glsl = "shadow/map/sat_vsm/sat_vsm.glsl";
        p.add_map = add_sat_vsm;
        p.guard = guard;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
