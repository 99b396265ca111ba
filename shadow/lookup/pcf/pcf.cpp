// SPDX-License-Identifier: MIT
// Percentage-closer filtering over any placement, grids by gathers, discs by single texels or bilinear taps.
//
// Based on: Reeves, Salesin, Cook. Rendering Antialiased Shadows with Depth Maps. SIGGRAPH 1987. [RSC87]
#include "shadow/lookup/pcf/pcf.h"

#include "shadow/lookup/pcf/pcf.glsl"
#include "shadow/lookup/poisson.h"
#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"

namespace gn::parts::pcf {
namespace {

bool is_grid(const GnPcfParams& params) {
    return params.kernel <= GN_PCF_GAUSSIAN;
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    const auto params = recipe.of<GnPcfParams>("pcf");
    Guard guard;
    if (is_grid(params)) {
        const int size = glsl::gn_pcf_size(params.kernel, params.size);
        guard.texels = 0.5F * static_cast<float>(glsl::gn_pcf_footprint(params.kernel, size)) + 1.0F;
    } else if (params.radius_world > 0) {
        guard = {.texels = 1, .metres = params.radius_world};
    } else {
        guard.texels = params.radius + 1;
    }
    if (!is_grid(params) && params.tap == GN_PCF_FOUR_TEXELS) {
        guard.texels += 1;  // the texels beside the one that a tap falls into
    }
    guard.pixels = params.footprint == GN_PCF_OF_PIXEL ? 1.0F : 0.0F;
    return guard;
}

std::vector<std::string_view> needs_for(const Recipe& recipe) {
    const auto& params = recipe.of<GnPcfParams>("pcf");
    if (params.extremes == GN_PCF_NO_EXTREMES) {
        return {"depth"};
    }
    return {"depth", params.extremes == GN_PCF_BLOCKS ? "block-min-max" : "min-max"};
}

/// The taps of a disc kernel on the unit disc, before it is turned.
std::vector<vec2> disc_of(const GnPcfParams& params) {
    if (params.kernel != GN_PCF_VOGEL) {
        return poisson_disc(params.taps, static_cast<unsigned>(params.seed)).points;
    }
    std::vector<vec2> points;
    for (int i = 0; i < params.taps; ++i) {
        points.push_back(glsl::gn_vogel(i, params.taps, 0));
    }
    spread(points);
    return points;
}

/// Fixes the kernel and the loops' counts, and brings the generated set of taps.
std::string prologue(const Recipe& recipe) {
    const auto params = recipe.of<GnPcfParams>("pcf");
    std::string text = fmt::format("#define GN_PCF_KERNEL {}\n#define GN_PCF_OVER_PIXEL {}\n", params.kernel,
                                   params.footprint == GN_PCF_OF_PIXEL);
    text += params.extremes == GN_PCF_NO_EXTREMES ? "" : "#define GN_PCF_EXTREMES\n";
    if (is_grid(params)) {
        const int size = glsl::gn_pcf_size(params.kernel, params.size);
        text += fmt::format("#define GN_PCF_SIZE {}\n", size);
        text += fmt::format("#define GN_PCF_FOOTPRINT {}\n", glsl::gn_pcf_footprint(params.kernel, size));
        return text;
    }
    text += fmt::format("#define GN_PCF_TAP {}\n", params.tap);
    text += fmt::format("#define GN_PCF_TAPS {}\n#define GN_PCF_EARLY_OUT {}\n", params.taps, params.early_out != 0);
    const std::vector<vec2> disc = disc_of(params);
    const std::size_t probes = std::min<std::size_t>(8, disc.size());
    text += glsl_fours("GN_PCF_PROBES", std::span(disc).first(probes));
    text += glsl_fours("GN_PCF_OTHERS", std::span(disc).subspan(probes));
    return text;
}

ParamTable rows() {
    return param_table<GnPcfParams>({
        GN_CHOICE(
            GnPcfParams, kernel,
            "What the taps form: grids are exact box or Gaussian filters of the map, discs trade banding for noise.",
            "2x2", "3x3", "nxn", "bilinear", "bilinear-nxn", "gaussian", "poisson", "rotated-poisson", "vogel"),
        GN_CHOICE(GnPcfParams, footprint,
                  "What the taps cover: the kernel alone, or the pixel's own footprint on the map where that is larger "
                  "(grids) or besides (discs), so that fine shadows far away fade instead of flicker.",
                  "kernel", "pixel"),
        GN_PARAM(GnPcfParams, size, integer, 1, 31, "texels",
                 "Side of the n x n grids: wider edges, cost grows with its square."),
        GN_PARAM(GnPcfParams, taps, integer, 1, 128, "", "Taps of disc kernels: less noise, cost grows in proportion."),
        GN_PARAM(GnPcfParams, radius, real, 0, 64, "texels", "Radius of disc kernels: softer edges, lost detail."),
        GN_PARAM(GnPcfParams, radius_world, real, 0, 100, "m",
                 "Radius of disc kernels on the receiver; above zero it replaces radius and keeps edges equally soft "
                 "everywhere."),
        GN_PARAM(GnPcfParams, early_out, boolean, 0, 1, "",
                 "Stops after 8 taps that agree: faster, but specks smaller than the gaps between them are lost."),
        GN_PARAM(GnPcfParams, seed, integer, 0, 65535, "", "Another Poisson set; nothing else changes."),
        GN_CHOICE(GnPcfParams, tap,
                  "What a disc kernel's tap compares: the texel that it falls into, or the four around it, weighed "
                  "bilinearly, so that coarse texels do not show as steps within the kernel.",
                  "texel", "bilinear"),
        GN_CHOICE(GnPcfParams, extremes,
                  "Which least and greatest depths end a kernel early where they say that all of it is lit, or none: "
                  "of single texels, or of blocks of 8 x 8, which are made in a fraction of the time and decide less. "
                  "V stays the same, to the rounding of a grid's weights; pays for wide kernels.",
                  "none", "texels", "blocks"),
    });
}

}  // namespace
}  // namespace gn::parts::pcf

namespace gn::parts {

const Part& lookup_pcf() {
    using namespace pcf;
    static const Part part = [] {
        Part p;
        p.id = "pcf";
        p.stage = Stage::lookup;
        p.title = "Percentage-closer filtering";
        p.citation = "RSC87";
        p.needs = {"depth"};
        p.needs_for = needs_for;
        p.optional = {"ids"};
        p.sides = {
            {"confidence", "", "How near the centre of its texel a sample lies: 1 at it, 0 at the texel's border."},
            {"kernel-reach", "m", "How far around a sample, across the rays, casters change its V."}};
        p.params = rows();
        p.params_type = "GnPcfParams";
        p.glsl = "shadow/lookup/pcf/pcf.glsl";
        p.guard = guard;
        p.prologue = prologue;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
