// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows in a few fetches of a prefiltered map.
//
// Based on: Yang, Dong, Feng, Seidel, Kautz. Variance Soft Shadow Mapping. Pacific Graphics 2010. [YDF+10]
// Stands on: shadow/receiver/light_extent.glsl (the light as a receiver sees it, and where what hides it can lie)
#include "shadow/lookup/vssm/vssm.h"

#include "shadow/recipe/light_guard.h"
#include "shadow/recipe/recipe.h"

namespace gn::parts::vssm {
namespace {

Guard guard(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    return light_guard(light, bounds_ws, recipe.of<GnVssmParams>("vssm").least);
}

}  // namespace
}  // namespace gn::parts::vssm

namespace gn::parts {

const Part& lookup_vssm() {
    using namespace vssm;
    static const Part part = [] {
        Part p;
        p.id = "vssm";
        p.stage = Stage::lookup;
        p.title = "Soft shadows from a prefiltered map";
        p.citation = "YDF+10";
        p.needs = {"min-max"};
        p.filters = true;
        p.sides = {{"blocker-distance", "m",
                    "How far along the light's depth what hides a sample lies before it, on average."},
                   {"penumbra-width", "m", "How wide the penumbra is at a sample, across the rays."}};
        p.params = param_table<GnVssmParams>({
            GN_PARAM(GnVssmParams, side, integer, 1, 8, "",
                     "Parts along a side of a kernel: less bleeding and truer slopes, cost grows with its square."),
            GN_PARAM(GnVssmParams, least, real, 0, 16, "texels",
                     "Half width of the narrowest kernel: below one the map's texels show at contacts."),
            GN_PARAM(GnVssmParams, early_out, boolean, 0, 1, "",
                     "Skips the search and the filter where the least and greatest depth of their region say that all "
                     "of the "
                     "light is seen, or none: V is the same."),
        });
        p.params_type = "GnVssmParams";
        p.glsl = "shadow/lookup/vssm/vssm.glsl";
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
