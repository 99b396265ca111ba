// SPDX-License-Identifier: MIT
// Based on: Blinn. Me and My (Fake) Shadow. IEEE Computer Graphics and Applications 1988. [Bli88]
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, section 7.1. 2018. [AHH18]
// Departs from it: receiver planes are found in the mesh, and the stencil names the plane of each view sample.
#include "shadow/direct/planar/planar.h"

#include "shadow/geometry/flattened.h"
#include "shadow/recipe/recipe.h"

namespace gn::parts::planar {
namespace {

Visibility add_planar(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnPlanarParams>("planar");
    const auto found = flat_receivers(input, {params.planes, params.min_area, params.tolerance}, "planar");
    return add_flat_shadow(input, *found);
}

}  // namespace
}  // namespace gn::parts::planar

namespace gn::parts {

const Part& direct_planar() {
    using namespace planar;
    static const Part part = [] {
        Part p;
        p.id = "planar";
        p.stage = Stage::direct;
        p.title = "Planar shadows";
        p.citation = "Bli88";
        p.features = {Feature::depth32_stencil8};
        p.needs_scene = true;
        p.params = param_table<GnPlanarParams>({
            GN_PARAM(GnPlanarParams, planes, integer, 1, 64, "",
                     "More flat receivers get shadows, each for one more drawing of all casters."),
            GN_PARAM(GnPlanarParams, min_area, real, 0, 1, "of the scene's surface",
                     "Smaller flat parts stay without shadow."),
            GN_PARAM(GnPlanarParams, tolerance, real, 1e-7, 1e-2, "of the scene's diagonal",
                     "Rougher planes receive; what stands lower than this above one casts nothing."),
        });
        p.params_type = "GnPlanarParams";
        p.glsl = "shadow/geometry/flattened.glsl";
        p.add_direct = add_planar;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
