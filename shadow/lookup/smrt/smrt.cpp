// SPDX-License-Identifier: MIT
// Soft shadows by rays through the map, in the light's physical size, over any placement.
//
// Based on: Agrawala, Ramamoorthi, Heirich, Moll. Efficient Image-Based Methods for Rendering Soft Shadows. SIGGRAPH 2000. [ARHM00]
// Stands on: shadow/receiver/light_extent.glsl (the light as a receiver sees it, and how far that reaches over the map)
// Also here: rays.glsl (a ray's way through a map)
#include "shadow/lookup/smrt/smrt.h"

#include "shadow/recipe/light_guard.h"
#include "shadow/recipe/recipe.h"

namespace gn::parts::smrt {
namespace {

Guard guard(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    return light_guard(light, bounds_ws, recipe.of<GnSmrtParams>("smrt").least);
}

ParamTable rows() {
    return param_table<GnSmrtParams>({
        GN_PARAM(GnSmrtParams, rays, integer, 1, 256, "",
                 "Points of the light that each sample asks for: noise falls, cost grows with them."),
        GN_PARAM(GnSmrtParams, steps, integer, 1, 128, "",
                 "Texels that a ray reads at most, one a texel of its way where that is shorter: thin casters slip "
                 "between few."),
        GN_PARAM(GnSmrtParams, least, real, 0, 16, "texels",
                 "Half width of the narrowest fan of rays: 0 leaves the map's texels as they are at contacts and under "
                 "lights without size."),
        GN_CHOICE(GnSmrtParams, gaps,
                  "What a nearer surface covers: light passes there unless it was seen beside it, which leaks, or "
                  "what ends beneath goes on as it was last seen, which may darken too much.",
                  "open", "extended"),
        GN_PARAM(GnSmrtParams, steepest, real, 0.1, 1000, "",
                 "Tangent over the receiver's plane up to which two depths beside each other belong to one surface: "
                 "small lets light through walls, large closes gaps between casters one behind the other."),
        GN_CHOICE(GnSmrtParams, noise,
                  "What turns the rays: the texel of the map that a sample falls into, on which noise stays as the "
                  "camera moves, or the pixel.",
                  "texel", "pixel"),
    });
}

}  // namespace
}  // namespace gn::parts::smrt

namespace gn::parts {

const Part& lookup_smrt() {
    using namespace smrt;
    static const Part part = [] {
        Part p;
        p.id = "smrt";
        p.stage = Stage::lookup;
        p.title = "Rays through the shadow map";
        p.citation = "ARHM00";
        p.needs = {"depth", "block-min-max"};
        p.searches_pages = true;
        p.sides = {
            {"confidence", "", "How near the centre of its texel a sample lies: 1 at it, 0 at the texel's border."},
            {"kernel-reach", "m", "How far around a sample, across the rays, casters change its V."}};
        p.params = rows();
        p.params_type = "GnSmrtParams";
        p.glsl = "shadow/lookup/smrt/smrt.glsl";
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
