// SPDX-License-Identifier: MIT
// One map focused on the potential shadow receivers PSR = L ∩ V ∩ S. Near and far come from the same body; casters
// before the near plane are kept by depth clamping.
//
// Based on: Brabec, Annen, Seidel. Practical Shadow Mapping. Journal of Graphics Tools 2002. [BAS02b]
#include "shadow/geometry/convex_body.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/light_views.h"
#include "shadow/recipe/guard.h"

namespace gn::parts::fit {
namespace {

LightViews place_fit(const FrameInput& input, const Recipe& recipe) {
    const GnLight& light = input.light().shape;
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    ConvexBody body = potential_receivers(input);
    if (body.empty()) {
        // Nothing can receive: any view will do.
        body = body_of(Box{vec3(-1), vec3(1)});
    }
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        views.kind = ViewKind::affine;
        views.views = {fit_orthographic(body, light, recipe.resolution, guard_of(input, recipe))};
        return views;
    }
    const Fitted fitted = fit_perspective(body, light, recipe.resolution, guard_of(input, recipe));
    if (fitted.valid) {
        views.views = {fitted.view};
    } else {
        // The receivers surround the light.
        add_cube_views(views, input, guard_of(input, recipe), recipe.resolution);
    }
    return views;
}

}  // namespace
}  // namespace gn::parts::fit

namespace gn::parts {

const Part& placement_fit() {
    using namespace fit;
    static const Part part = [] {
        Part p;
        p.id = "fit";
        p.stage = Stage::placement;
        p.title = "One map focused on the potential shadow receivers";
        p.citation = "BAS02b";
        // It refuses an environment by name.
        p.stands_in_for = {.directional = true, .spot = true, .rectangle = true, .environment = true};
        p.data_type = "GnFacesData";
        p.glsl = "shadow/placement/fit/fit.glsl";
        p.place = place_fit;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
