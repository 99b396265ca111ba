// SPDX-License-Identifier: MIT
// One map warped by a perspective along the view whose rows follow a logarithm: the same error near and far.
//
// Based on: Lloyd. Logarithmic Perspective Shadow Maps. University of North Carolina at Chapel Hill 2007. [Llo07]
// Departs from it: the warp acts on the light's plane (shadow/placement/warp_rows.cpp), and hardware that draws straight edges
// bounds triangles, of which every texel finds its own point (shadow/receiver/logarithm.glsl).
#include "shadow/placement/logpsm/logpsm.h"

#include "shadow/placement/warp.h"

namespace gn::parts::logpsm {
namespace {

GnLightView choose_view(const warp::Plane2& plane, const Recipe& recipe) {
    return warp::logarithmic_view(plane, static_cast<double>(recipe.of<GnLogpsmParams>("logpsm").eta));
}

LightViews place_logpsm(const FrameInput& input, const Recipe& recipe) {
    return warp::place(input, recipe, static_cast<double>(recipe.of<GnLogpsmParams>("logpsm").near), choose_view);
}

}  // namespace
}  // namespace gn::parts::logpsm

namespace gn::parts {

const Part& placement_logpsm() {
    using namespace logpsm;
    static const Part part = [] {
        Part p;
        p.id = "logpsm";
        p.stage = Stage::placement;
        p.title = "Logarithmic perspective shadow maps";
        p.citation = "Llo07";
        p.bends = true;
        p.params = param_table<GnLogpsmParams>({
            GN_PARAM(
                GnLogpsmParams, near, real, 0, 0.1, "of the depth",
                "Pseudo-near plane, as a share of the farthest receiver's depth: receivers nearer than it get coarser "
                "texels, all others finer ones."),
            GN_PARAM(
                GnLogpsmParams, eta, real, -1, 1, "",
                "Strength of the perspective before its rows are spread: -1 leaves the fitted map, 1 makes the error "
                "across the view the same everywhere too."),
        });
        p.params_type = "GnLogpsmParams";
        p.data_type = "GnFacesData";
        p.glsl = "shadow/placement/logpsm/logpsm.glsl";
        p.place = place_logpsm;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
