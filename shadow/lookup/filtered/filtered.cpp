// SPDX-License-Identifier: MIT
// The one lookup of all prefiltered maps: it chooses the footprint, the map answers for it.
//
// Based on: Donnelly, Lauritzen. Variance Shadow Maps. I3D 2006. [DL06]
#include "shadow/lookup/filtered/filtered.h"

#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"

namespace gn::parts::filtered {
namespace {

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    const auto params = recipe.of<GnFilteredParams>("filtered");
    switch (params.footprint) {
        case GN_FILTERED_RADIUS: return {.texels = params.radius + 2};
        case GN_FILTERED_WORLD:
            return {.texels = params.radius_world > 0 ? 2 : params.radius + 2, .metres = params.radius_world};
        default: return {.texels = 4};
    }
}

}  // namespace
}  // namespace gn::parts::filtered

namespace gn::parts {

const Part& lookup_filtered() {
    using namespace filtered;
    static const Part part = [] {
        Part p;
        p.id = "filtered";
        p.stage = Stage::lookup;
        p.title = "One filtered fetch of a prefiltered map";
        p.citation = "DL06";
        p.filters = true;
        p.params = param_table<GnFilteredParams>({
            GN_CHOICE(GnFilteredParams, footprint,
                      "What is averaged: the pixel's own footprint, or a kernel of a radius in texels or in metres.",
                      "pixel", "radius", "world"),
            GN_PARAM(GnFilteredParams, radius, real, 0, 128, "texels",
                     "Half the kernel's side for footprint=radius: softer edges, more bleeding."),
            GN_PARAM(GnFilteredParams, radius_world, real, 0, 100, "m",
                     "Half the kernel's side on the receiver for footprint=world; 0 takes `radius` texels."),
            GN_PARAM(GnFilteredParams, sharpness, real, 0.1, 8, "",
                     "Divides the pixel's footprint: sharper shadows far away, more flicker."),
        });
        p.params_type = "GnFilteredParams";
        p.glsl = "shadow/lookup/filtered/filtered.glsl";
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
