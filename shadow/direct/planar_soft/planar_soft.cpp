// SPDX-License-Identifier: MIT
// Soft shadows on flat receivers: the mean of the hard shadows of many points of the light, or one hard shadow, blurred.
//
// Based on: Heckbert, Herf. Simulating Soft Shadows with Graphics Hardware. CMU-CS-97-104, 1997. [HH97]
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, section 7.1.2. 2018. [AHH18]
//
// Also here: planar_soft_passes.h, planar_soft_accumulate.cpp, planar_soft_blur.cpp.
#include "shadow/direct/planar_soft/planar_soft_passes.h"

#include "shadow/recipe/recipe.h"

namespace gn::parts::planar_soft {
namespace {

Visibility add_planar_soft(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnPlanarSoftParams>("planar-soft");
    const auto found = flat_receivers(input, {params.planes, params.min_area, params.tolerance}, "planar-soft");
    return params.mode == GN_PLANAR_SOFT_ACCUMULATE ? add_accumulated(input, *found, params)
                                                    : add_blurred(input, *found, params);
}

}  // namespace
}  // namespace gn::parts::planar_soft

namespace gn::parts {

const Part& direct_planar_soft() {
    using namespace planar_soft;
    static const Part part = [] {
        Part p;
        p.id = "planar-soft";
        p.stage = Stage::direct;
        p.title = "Soft planar shadows, accumulated or blurred";
        p.citation = "HH97";
        p.features = {Feature::depth32_stencil8, Feature::float32_blend};
        p.needs_scene = true;
        p.params = param_table<GnPlanarSoftParams>({
            GN_CHOICE(GnPlanarSoftParams, mode,
                      "accumulate is right for any caster; blur costs one drawing and has one width everywhere.",
                      "accumulate", "blur"),
            GN_PARAM(GnPlanarSoftParams, samples, integer, 1, 1024, "",
                     "Points of the light that are accumulated: finer steps, cost grows in proportion."),
            GN_PARAM(GnPlanarSoftParams, height, real, 0, 1, "of the casters' height",
                     "The blur is as wide as the penumbra of what is so high; lower casters blur too much."),
            GN_PARAM(GnPlanarSoftParams, texels, integer, 16, 4096, "texels",
                     "Side of the picture of each plane that is blurred: sharper steps where blur is narrow."),
            GN_PARAM(GnPlanarSoftParams, planes, integer, 1, 64, "",
                     "More flat receivers get shadows, each for one more drawing of all casters a point."),
            GN_PARAM(GnPlanarSoftParams, min_area, real, 0, 1, "of the scene's surface",
                     "Smaller flat parts stay without shadow."),
            GN_PARAM(GnPlanarSoftParams, tolerance, real, 1e-7, 1e-2, "of the scene's diagonal",
                     "Rougher planes receive; what stands lower than this above one casts nothing."),
        });
        p.params_type = "GnPlanarSoftParams";
        p.glsl = "shadow/direct/planar_soft/planar_soft.glsl";
        p.add_direct = add_planar_soft;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
