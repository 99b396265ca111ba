// SPDX-License-Identifier: MIT
// One map, fitted to the potential shadow receivers and warped along the view, at most as strongly as it helps.
//
// Based on: Wimmer, Scherzer, Purgathofer. Light Space Perspective Shadow Maps. EGSR 2004. [WSP04]
// Departs from it: the warp fades by Lloyd's function of the angle between view and light, not by its sine [Llo07], and
// is weakened further where some receiver would get coarser texels than the unwarped map's worst.
#include "shadow/placement/lispsm/lispsm.h"

#include "shadow/placement/warp.h"

#include <algorithm>

namespace gn {
namespace {

/// The rectangle turns to the unwarped map's as the warp fades, so that the two meet.
warp::Warp warp_of(const warp::Plane2& plane, double eta) {
    const double fade = std::clamp((-0.2 - eta) / 0.8, 0.0, 1.0);
    return warp::make_warp(plane, warp::strength_of(eta, plane.near, plane.far, plane.length), fade * plane.turn);
}

GnLightView choose_view(const warp::Plane2& plane, const Recipe& recipe) {
    const auto params = recipe.of<GnLispsmParams>("lispsm");
    const double full = (1 + warp::falloff(plane.angle, plane.half_field)) * (1 + static_cast<double>(params.eta));
    if (full <= 0) {
        return plane.fitted;
    }

    // Take the full warp where it does no harm; else the strongest that does none, by bisection.
    const double limit = 1.001 * warp::worst_error(plane, warp_of(plane, -1));
    warp::Warp best = warp_of(plane, full - 1);
    if (warp::worst_error(plane, best) <= limit) {
        return warp::view_of(plane, best);
    }
    double low = 0;
    double high = full;
    for (int step = 0; step < 20; ++step) {
        const double middle = 0.5 * (low + high);
        const warp::Warp tried = warp_of(plane, middle - 1);
        (warp::worst_error(plane, tried) <= limit ? low : high) = middle;
    }
    return low <= 1e-5 ? plane.fitted : warp::view_of(plane, warp_of(plane, low - 1));
}

LightViews place_lispsm(const FrameInput& input, const Recipe& recipe) {
    return warp::place(input, recipe, static_cast<double>(recipe.of<GnLispsmParams>("lispsm").near), choose_view);
}

}  // namespace

namespace parts {

const Part& placement_lispsm() {
    static const Part part = [] {
        Part p;
        p.id = "lispsm";
        p.stage = Stage::placement;
        p.title = "Light space perspective shadow maps";
        p.citation = "WSP04";
        p.params = param_table<GnLispsmParams>({
            GN_PARAM(
                GnLispsmParams, near, real, 0, 1e6, "m",
                "Pseudo-near plane: a larger one gives far receivers finer texels and those nearer than it coarser "
                "ones."),
            GN_PARAM(GnLispsmParams, eta, real, -1, 1, "",
                     "Strength of the warp: -1 leaves the fitted map, 0 makes the error along the view equal at both "
                     "ends, 1 favours the nearest receivers as perspective shadow maps do."),
        });
        p.params_type = "GnLispsmParams";
        p.glsl = "shadow/placement/lispsm/lispsm.glsl";
        p.place = place_lispsm;
        return p;
    }();
    return part;
}

}  // namespace parts
}  // namespace gn
