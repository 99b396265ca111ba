// SPDX-License-Identifier: MIT
// One map, fitted to the potential shadow receivers and warped along the view, at most as strongly as it helps.
//
// Based on: Wimmer, Scherzer, Purgathofer. Light Space Perspective Shadow Maps. EGSR 2004. [WSP04]
// Departs from it: unless asked for the original, the warp fades by Lloyd's function of the angle between view and light, not
// by its sine [Llo07], and is weakened further where some receiver would get coarser texels than the unwarped map's worst.
#include "shadow/placement/lispsm/lispsm.h"

#include "shadow/placement/warp.h"

namespace gn::parts::lispsm {
namespace {

GnLightView choose_view(const warp::Plane2& plane, const Recipe& recipe) {
    const auto params = recipe.of<GnLispsmParams>("lispsm");
    const auto eta = static_cast<double>(params.eta);
    return params.falloff == GN_LISPSM_WSP04 ? warp::sine_view(plane, eta) : warp::even_view(plane, eta);
}

LightViews place_lispsm(const FrameInput& input, const Recipe& recipe) {
    return warp::place(input, recipe, static_cast<double>(recipe.of<GnLispsmParams>("lispsm").near), choose_view);
}

}  // namespace
}  // namespace gn::parts::lispsm

namespace gn::parts {

const Part& placement_lispsm() {
    using namespace lispsm;
    static const Part part = [] {
        Part p;
        p.id = "lispsm";
        p.stage = Stage::placement;
        p.title = "Light space perspective shadow maps";
        p.citation = "WSP04";
        p.params = param_table<GnLispsmParams>({
            GN_CHOICE(GnLispsmParams, falloff,
                      "How the warp fades as the light turns into the view: by Lloyd's function and never beyond what "
                      "helps, or by the sine of the angle as first published, which is too strong at small angles.",
                      "lloyd", "wsp04"),
            GN_PARAM(GnLispsmParams, near, real, 0, 0.1, "of the depth",
                     "Pseudo-near plane, as a share of the farthest receiver's depth: a larger one gives far receivers "
                     "finer texels and those nearer than it coarser "
                     "ones."),
            GN_PARAM(GnLispsmParams, eta, real, -1, 1, "",
                     "Strength of the warp: -1 leaves the fitted map, 0 makes the error along the view equal at both "
                     "ends, 1 favours the nearest receivers as perspective shadow maps do."),
        });
        p.params_type = "GnLispsmParams";
        p.data_type = "GnFacesData";
        p.glsl = "shadow/placement/lispsm/lispsm.glsl";
        p.place = place_lispsm;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
