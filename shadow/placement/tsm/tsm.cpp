// SPDX-License-Identifier: MIT
// One map whose receivers are framed by a trapezoid; the focus region gets four fifths of it.
//
// Based on: Martin, Tan. Anti-aliasing and Continuity with Trapezoidal Shadow Maps. EGSR 2004. [MT04]
// Departs from it: the trapezoid frames the potential shadow receivers, not the whole eye frustum.
#include "shadow/placement/tsm/tsm.h"

#include "shadow/placement/warp.h"

#include <algorithm>

namespace gn::parts::tsm {
namespace {

/// 1/n for the centre of projection that maps the focus to `share` of the trapezoid's height [MT04, section 5.1].
double strength_of(const warp::Plane2& plane, double focus, double share) {
    // The focus as a share of the height d of the trapezoid: its top line is the nearest receivers'.
    const double d = std::max(1e-3, (focus - plane.near) / (plane.far - plane.near));
    // s(y) = y (n + h) / (h (n + y)) with s(d h) = share gives n = h d (1 - share) / (share - d).
    return d >= share ? 0 : (share - d) / (plane.length * d * (1 - share));
}

GnLightView choose_view(const warp::Plane2& plane, const Recipe& recipe) {
    const auto params = recipe.of<GnTsmParams>("tsm");
    const double focus = params.focus > 0 ? static_cast<double>(params.focus) : std::sqrt(plane.near * plane.far);
    const double strength = strength_of(plane, focus, static_cast<double>(params.share));
    return strength > 0 ? warp::view_of(plane, warp::make_warp(plane, strength, 0)) : plane.fitted;
}

LightViews place_tsm(const FrameInput& input, const Recipe& recipe) {
    return warp::place(input, recipe, static_cast<double>(recipe.of<GnTsmParams>("tsm").near), choose_view);
}

}  // namespace
}  // namespace gn::parts::tsm

namespace gn::parts {

const Part& placement_tsm() {
    using namespace tsm;
    static const Part part = [] {
        Part p;
        p.id = "tsm";
        p.stage = Stage::placement;
        p.title = "Trapezoidal shadow maps";
        p.citation = "MT04";
        p.params = param_table<GnTsmParams>({
            GN_PARAM(GnTsmParams, near, real, 0, 0.1, "of the depth",
                     "Pseudo-near plane, as a share of the farthest receiver's depth: a larger one gives far receivers "
                     "finer texels and those nearer than it coarser "
                     "ones."),
            GN_PARAM(
                GnTsmParams, focus, real, 0, 1e9, "m",
                "Receivers up to this distance share most of the map: a larger one spreads the texels more evenly; "
                "0 takes the geometric mean of the nearest and the farthest receiver."),
            GN_PARAM(GnTsmParams, share, real, 0.05, 0.95, "of the map",
                     "How much of the map the focus region gets; more leaves distant receivers fewer texels."),
        });
        p.params_type = "GnTsmParams";
        p.data_type = "GnFacesData";
        p.glsl = "shadow/placement/tsm/tsm.glsl";
        p.place = place_tsm;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
