// SPDX-License-Identifier: MIT
// Layered variance shadow maps: variance maps of intervals of depth, split where light would bleed.
//
// Based on: Lauritzen, McCool. Layered Variance Shadow Maps. Graphics Interface 2008. [LM08]
//
// Stands on: shadow/map/vsm (a layer is a variance map of warped depth)
// Also here: lvsm_passes.h, lloyd.cpp, lloyd.glsl, warp.cpp.
#include "shadow/map/lvsm/lvsm.h"

#include "shadow/map/lvsm/lvsm_passes.h"
#include "shadow/map/prefilter.h"

namespace gn {
namespace {

ShadowMap add_lvsm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnLvsmParams>("lvsm");
    const std::uint32_t mips = params.mipmaps != 0 ? full_chain(views.resolution) : 1;

    // Draw depths, split them into layers, and warp each layer.
    const TextureHandle depths = add_depths(input, recipe, views, params);
    ShadowMap map;
    if (params.splits == GN_LVSM_LLOYD) {
        map.extra = add_lloyd(input, depths, params);
    }
    const BlurKernel blur = params.radius == 0 ? BlurKernel::none : static_cast<BlurKernel>(params.blur);
    const TextureHandle warped = add_warp(input, depths, map.extra, params, blur == BlurKernel::none ? mips : 1);

    // Blur and mipmap.
    map.texture = add_blur(input, warped, blur, params.radius, mips);
    add_mips(input, map.texture);
    map.sampler = trilinear();
    map.sampler.anisotropy = static_cast<float>(params.anisotropy);
    return map;
}

Guard guard(const Recipe& recipe) {
    const auto params = recipe.of<GnLvsmParams>("lvsm");
    return blur_guard(static_cast<BlurKernel>(params.blur), params.radius);
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    return refuse_samples("lvsm.samples", recipe.of<GnLvsmParams>("lvsm").samples);
}

ParamTable rows() {
    return param_table<GnLvsmParams>({
        GN_PARAM(GnLvsmParams, layers, integer, 1, GN_LVSM_MAX_LAYERS, "",
                 "Layers of depth: less bleeding, four or eight bytes a texel each."),
        GN_CHOICE(GnLvsmParams, splits,
                  "Where layers meet: at equal distances, or where occluders lie behind edges of others.", "uniform",
                  "lloyd"),
        GN_PARAM(GnLvsmParams, iterations, integer, 1, 64, "",
                 "Steps of the relaxation a frame: the splits follow the scene sooner."),
        GN_PARAM(GnLvsmParams, overlap, real, 0, 0.5, "layers",
                 "How far layers reach over their splits, in widths of an equal layer: hides seams, some bleeding."),
        GN_PARAM(GnLvsmParams, transition, real, 0, 1, "",
                 "Share of the overlap in which two layers are blended: smoother seams, two fetches there."),
        GN_CHOICE(GnLvsmParams, format, "What moments are stored in: 16-bit fixed point, or twice the memory.",
                  "unorm16", "float32"),
        GN_PARAM(GnLvsmParams, samples, integer, 1, 4, "",
                 "Samples a texel, 1 or 4: smoother edges, four times the memory while drawing."),
        GN_CHOICE(GnLvsmParams, blur, "The kernel that the map is blurred with.", "none", "box", "gaussian"),
        GN_PARAM(GnLvsmParams, radius, integer, 0, 64, "texels",
                 "Reach of the blur: softer edges and more bleeding, cost grows in proportion."),
        GN_PARAM(GnLvsmParams, mipmaps, boolean, 0, 1, "", "Smooths distant shadows; a third more memory."),
        GN_PARAM(GnLvsmParams, anisotropy, integer, 1, 16, "",
                 "Fetches along stretched footprints: sharper at grazing views, slow in software."),
        GN_PARAM(GnLvsmParams, slope_moment, boolean, 0, 1, "",
                 "Adds the slope of the surface to the second moment: no acne on slanted surfaces."),
        GN_PARAM(GnLvsmParams, min_deviation, real, 0, 1, "m",
                 "Least standard deviation assumed: less acne, softer contacts."),
        GN_PARAM(GnLvsmParams, bleeding, real, 0, 0.99, "",
                 "Share of the bound cut off: less bleeding, darker and harder penumbrae."),
    });
}

}  // namespace

namespace parts {

const Part& map_lvsm() {
    static const Part part = [] {
        Part p;
        p.id = "lvsm";
        p.stage = Stage::map;
        p.title = "Layered variance shadow maps";
        p.citation = "LM08";
        p.gives = "filterable";
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

}  // namespace parts
}  // namespace gn
