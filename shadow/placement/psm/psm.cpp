// SPDX-License-Identifier: MIT
// One map warped as strongly as the camera's own perspective: texels are as wide on screen far away as near.
//
// Based on: Stamminger, Drettakis. Perspective Shadow Maps. SIGGRAPH 2002. [SD02]
// Departs from it: the warp acts on the light's plane, where no light turns into another kind and none ends up behind
// the camera; for a light perpendicular to the view the map is the same [LTYM06].
#include "shadow/placement/psm/psm.h"

#include "shadow/placement/warp.h"

namespace gn::parts::psm {
namespace {

GnLightView choose_view(const warp::Plane2& plane, const Recipe& recipe) {
    // The centre of projection is the virtual camera's, n = z_n from the nearest receiver.
    const double back = static_cast<double>(recipe.of<GnPsmParams>("psm").back) * plane.far;
    const double strength = warp::strength_of(1, plane.near + back, plane.far + back, plane.length);
    return warp::view_of(plane, warp::make_warp(plane, strength, 0));
}

LightViews place_psm(const FrameInput& input, const Recipe& recipe) {
    return warp::place(input, recipe, 0.0, choose_view);
}

}  // namespace
}  // namespace gn::parts::psm

namespace gn::parts {

const Part& placement_psm() {
    using namespace psm;
    static const Part part = [] {
        Part p;
        p.id = "psm";
        p.stage = Stage::placement;
        p.title = "Perspective shadow maps";
        p.citation = "SD02";
        p.params = param_table<GnPsmParams>({
            GN_PARAM(GnPsmParams, back, real, 0, 1, "of the depth",
                     "Moves the virtual camera back, by a share of the farthest receiver's depth: distant receivers "
                     "get finer texels, near ones coarser; 0 spends "
                     "nearly all of the map on the nearest receivers."),
        });
        p.params_type = "GnPsmParams";
        p.data_type = "GnFacesData";
        p.glsl = "shadow/placement/psm/psm.glsl";
        p.place = place_psm;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
