// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows, in the light's physical size, over any placement.
//
// Based on: Fernando. Percentage-Closer Soft Shadows. SIGGRAPH Sketches 2005. [Fer05]
// Stands on: shadow/lookup/smrt (rays.glsl: a ray's way through a map)
// Also here: pcss_kernel.glsl (where the taps lie on the light), pcss_tap.glsl (a texel of the map as its kernels read it)
#include "shadow/lookup/pcss/pcss.h"

#include "shadow/lookup/poisson.h"
#include "shadow/lookup/smrt/smrt.h"
#include "shadow/recipe/light_guard.h"
#include "shadow/recipe/recipe.h"

namespace gn::parts::pcss {
namespace {

Guard guard(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    const auto params = recipe.of<GnPcssParams>("pcss");
    return light_guard(light, bounds_ws, params.least + (params.tap == GN_PCSS_FOUR_TEXELS ? 1.0F : 0.0F));
}

/// Points on the unit disc for as many taps as search or filter take, the first few of them all over it.
std::string set_of(const GnPcssParams& params) {
    std::vector<vec2> points =
        poisson_disc(std::max(params.search_taps, params.taps), static_cast<unsigned>(params.seed)).points;
    spread(points);
    std::string list;
    for (const vec2 p : points) {
        list += fmt::format("{}vec2({:.8f}, {:.8f})", list.empty() ? "" : ", ", p.x, p.y);
    }
    return fmt::format("#define GN_PCSS_SET {}\n#define GN_PCSS_SET_POINTS {}\n", list, points.size());
}

std::string prologue(const Recipe& recipe) {
    const auto& params = recipe.of<GnPcssParams>("pcss");
    std::string lines = fmt::format("#define GN_PCSS_TAP {}\n#define GN_PCSS_KERNEL {}\n", params.tap, params.kernel);
    if (params.kernel == GN_PCSS_POISSON || params.kernel == GN_PCSS_ROTATED_POISSON) {
        lines += set_of(params);
    }
    if (params.planes != 0) {
        lines += "#define GN_PCSS_PLANES\n";
    }
    if (params.rays > 0) {
        const GnSmrtParams rays;
        lines +=
            fmt::format("#define GN_PCSS_RAYS\n#define GN_PCSS_RAY_STEPS {}\n#define GN_PCSS_RAYS_STEEPEST {:.6e}\n",
                        rays.steps, rays.steepest);
    }
    return lines;
}

std::vector<std::string_view> needs_for(const Recipe& recipe) {
    const auto& params = recipe.of<GnPcssParams>("pcss");
    std::vector<std::string_view> needs{"depth", params.extremes == GN_PCSS_BLOCKS ? "block-min-max" : "min-max"};
    if (params.planes != 0) {
        needs.push_back("lower-planes");
    }
    return needs;
}

ParamTable rows() {
    return param_table<GnPcssParams>({
        GN_CHOICE(
            GnPcssParams, blocker,
            "Which depth the penumbra's width comes from, of all that hide the light: their mean, or the nearest to "
            "the light, which gives the widest.",
            "average", "nearest"),
        GN_PARAM(GnPcssParams, search_taps, integer, 1, 128, "",
                 "Taps of the search: fewer make widths jump from pixel to pixel."),
        GN_PARAM(GnPcssParams, taps, integer, 1, 256, "", "Taps of the widest filter: less noise, cost grows with it."),
        GN_PARAM(GnPcssParams, density, real, 0.1, 64, "per texel",
                 "Taps for each texel of the filter's half width, up to `taps`: narrow penumbrae cost less."),
        GN_PARAM(GnPcssParams, least, real, 0, 16, "texels",
                 "Half width of the narrowest filter: below one the map's texels show at contacts."),
        GN_PARAM(
            GnPcssParams, early_out, boolean, 0, 1, "",
            "Skips the search where the least and greatest depth of its region say that all of the light is seen, or "
            "none: V stays the same."),
        GN_CHOICE(GnPcssParams, extremes,
                  "Of what least and greatest depths are known: of single texels on, or of blocks of 8 x 8, which are "
                  "made in a fraction of the time, end fewer searches and widen those beside near casters.",
                  "texels", "blocks"),
        GN_PARAM(GnPcssParams, planes, boolean, 0, 1, "",
                 "Also asks planes before all depths of blocks of 8 x 8 texels whether all of the light is seen: least "
                 "depths "
                 "cannot tell of slanted ground that it is lit. V stays the same; pays where much of a large picture "
                 "is open."),
        GN_PARAM(GnPcssParams, rays, integer, 0, 256, "",
                 "Rays through the map, as smrt sends them, in place of search and filter where a caster cages the "
                 "light: each bar of a lantern keeps its own distance; 0 takes all casters for one plane there, too."),
        GN_PARAM(GnPcssParams, caged, real, 0, 1000, "half widths of the light",
                 "How near to a lamp a caster cages it: with more, rays go wherever something hides it, which costs "
                 "more and leaks where a caster hides another."),
        GN_CHOICE(
            GnPcssParams, noise,
            "What turns the taps: the place in the picture, so that noise swims over surfaces as the camera moves, or "
            "the place on the surface, on which it stays.",
            "pixel", "surface"),
        GN_CHOICE(GnPcssParams, tap,
                  "What a tap of the filter compares: the texel that it falls into, or the four around it, weighed "
                  "bilinearly, so that coarse texels do not show as steps within penumbrae.",
                  "texel", "bilinear"),
        GN_CHOICE(GnPcssParams, kernel,
                  "Where search and filter look on the light, in its own shape: a spiral, turned by the noise; a "
                  "Poisson set, as it is (bands) or turned (noise); the centres of a raster's cells (bands), of as "
                  "many as fit into the taps.",
                  "vogel", "poisson", "rotated-poisson", "grid"),
        GN_PARAM(GnPcssParams, seed, integer, 0, 65535, "", "Another Poisson set; nothing else changes."),
    });
}

}  // namespace
}  // namespace gn::parts::pcss

namespace gn::parts {

const Part& lookup_pcss() {
    using namespace pcss;
    static const Part part = [] {
        Part p;
        p.id = "pcss";
        p.stage = Stage::lookup;
        p.title = "Percentage-closer soft shadows";
        p.citation = "Fer05";
        p.needs = {"depth", "min-max"};
        p.needs_for = needs_for;
        p.searches_pages = true;
        p.sides = {
            {"search-class", "",
             "Why a search ended: 1 all of the light is seen, 2 none of it, 3 texels were read, 4 rays were sent."},
            {"blocker-distance", "m",
             "How far along the light's depth what hides a sample lies before it, on average."},
            {"penumbra-width", "m", "How wide the penumbra is at a sample, across the rays."},
            {"filter-radius", "m",
             "Radius of the filter at a sample on the light's plane: metres under a sun, else at a metre from the "
             "light; 0 where no part of the light is hidden."},
            {"confidence", "", "How near the centre of its texel a sample lies: 1 at it, 0 at the texel's border."},
            {"kernel-reach", "m", "How far around a sample, across the rays, casters change its V."}};
        p.params = rows();
        p.params_type = "GnPcssParams";
        p.glsl = "shadow/lookup/pcss/pcss.glsl";
        p.guard = guard;
        p.prologue = prologue;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
