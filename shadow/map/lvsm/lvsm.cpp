// SPDX-License-Identifier: MIT
// Layered variance shadow maps: variance maps of intervals of depth, split where light would bleed.
//
// Based on: Lauritzen, McCool. Layered Variance Shadow Maps. Graphics Interface 2008. [LM08]
//
// Stands on: shadow/map/vsm (a layer is a variance map of warped depth)
// Also here: lvsm_passes.h, lloyd.cpp, lloyd.glsl, lloyd_relax.glsl, warp.cpp.
#include "shadow/map/lvsm/lvsm.h"

#include "shadow/map/lvsm/lvsm_passes.h"
#include "shadow/map/prefilter.h"

namespace gn::parts::lvsm {
namespace {

ShadowMap add_lvsm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnLvsmParams>("lvsm");

    // Draw depths, split them into layers, and warp each layer.
    const TextureHandle depths = add_depths(input, recipe, views, params);
    const TextureHandle splits = params.splits == GN_LVSM_LLOYD ? add_lloyd(input, depths, params) : TextureHandle{};
    const TextureHandle warped = add_warp(input, depths, splits, params);

    // Blur and mipmap.
    ShadowMap map = filtered_map(input, views, "moments", warped, params.prefilter);
    if (splits.valid()) {
        map.offers.push_back({"splits", splits, nearest()});
    }
    return map;
}

std::vector<Feature> features_for(const Recipe& recipe) {
    return filtering_features(recipe.of<GnLvsmParams>("lvsm").format == GN_LVSM_FLOAT32);
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    return blur_guard(recipe.of<GnLvsmParams>("lvsm").prefilter);
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    return refuse_samples("lvsm.samples", recipe.of<GnLvsmParams>("lvsm").samples);
}

ParamTable rows() {
    return param_table<GnLvsmParams>(with_prefilter(
        {
            GN_PARAM(GnLvsmParams, layers, integer, 1, GN_LVSM_MAX_LAYERS, "",
                     "Layers of depth: less bleeding, two, four or eight bytes a texel each."),
            GN_CHOICE(GnLvsmParams, splits,
                      "Where layers meet: at equal distances, or where occluders lie behind edges of others.",
                      "uniform", "lloyd"),
            GN_PARAM(GnLvsmParams, iterations, integer, 1, 64, "",
                     "Steps of the relaxation a frame: the splits follow the scene sooner."),
            GN_PARAM(GnLvsmParams, weight_least, real, 0, 1, "of the depth range",
                     "Edges whose depths deviate less draw no split: splits stay away from uneven ground."),
            GN_PARAM(GnLvsmParams, weight_most, real, 0.001, 1, "of the depth range",
                     "Edges whose depths deviate more draw splits no harder: high casters leave some to low ones."),
            GN_PARAM(
                GnLvsmParams, overlap, real, 0, 0.5, "layers",
                "How far layers reach over their splits, in widths of an equal layer: hides seams, some bleeding."),
            GN_PARAM(GnLvsmParams, transition, real, 0, 1, "",
                     "Share of the overlap in which two layers are blended: smoother seams, two fetches there."),
            GN_CHOICE(GnLvsmParams, format,
                      "What moments are stored in: 16-bit fixed point, twice the memory, or half for many thin layers.",
                      "unorm16", "float32", "unorm8"),
            samples_row(offsetof(GnLvsmParams, samples)),
            slope_moment_row(offsetof(GnLvsmParams, slope_moment)),
            min_deviation_row(offsetof(GnLvsmParams, min_deviation)),
            bleeding_row(offsetof(GnLvsmParams, bleeding)),
        },
        offsetof(GnLvsmParams, prefilter)));
}

}  // namespace
}  // namespace gn::parts::lvsm

namespace gn::parts {

const Part& map_lvsm() {
    using namespace lvsm;
    static const Part part = [] {
        Part p;
        p.id = "lvsm";
        p.stage = Stage::map;
        p.title = "Layered variance shadow maps";
        p.citation = "LM08";
        p.filterable = true;
        p.gives = {"moments", "splits"};
        p.textures = {"moments", "splits"};
        p.features_for = features_for;
        p.params = rows();
        p.params_type = "GnLvsmParams";
        p.glsl = "shadow/map/lvsm/lvsm.glsl";
        p.add_map = add_lvsm;
        p.guard = guard;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
