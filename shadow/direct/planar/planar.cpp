// SPDX-License-Identifier: MIT
// Based on: Blinn. Me and My (Fake) Shadow. IEEE Computer Graphics and Applications 1988. [Bli88]
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, section 7.1. 2018. [AHH18]
// Departs from it: receiver planes are found in the mesh, and the stencil names the plane of each view sample.
#include "shadow/direct/planar/planar.h"

#include "shadow/geometry/flattened.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/recipe.h"

namespace gn {
namespace {

void add_receivers(const FrameInput& input, const std::vector<GnFlattening>& planes, TextureHandle image) {
    // First all samples, then plane after plane.
    std::vector<ShaderInputs> inputs{flat_receiver_inputs(input, {})};
    for (const GnFlattening& frame : planes) {
        inputs.push_back(flat_receiver_inputs(input, frame));
    }
    const std::array pipelines{flat_receiver_pipeline(input, inputs.front(), false),
                               flat_receiver_pipeline(input, inputs.front(), true)};
    input.graph.add_pass(
        "planar: receivers",
        [&](PassBuilder& pass) {
            pass.color(image, Load::clear);
            pass.depth_read_only(lent(input.samples.depth, "depth"));
            inputs.front().declare(pass);
        },
        [inputs, pipelines](Recorder& r) {
            for (std::uint32_t i = 0; i < inputs.size(); ++i) {
                r.bind(*pipelines[i == 0 ? 0 : 1]);
                r.stencil_reference(i);
                inputs[i].set(r);
                r.draw(3);
            }
        });
}

void add_casters(const FrameInput& input, const std::vector<GnFlattening>& planes, TextureHandle image) {
    const FlatCasters casters(input, {.fragment = "    result = 0.0;\n"});
    std::vector<ShaderInputs> inputs;
    for (const GnFlattening& frame : planes) {
        inputs.push_back(casters.inputs(frame, {}));
    }
    input.graph.add_pass(
        "planar: casters",
        [&](PassBuilder& pass) {
            pass.color(image, Load::keep);
            pass.depth_read_only(lent(input.samples.depth, "depth"));
            casters.declare(pass);
        },
        [casters, inputs](Recorder& r) {
            // A shadowed sample loses its plane's number, so that no second caster darkens it again.
            for (std::uint32_t i = 0; i < inputs.size(); ++i) {
                casters.record(r, inputs[i], i + 1);
            }
        });
}

Visibility add_planar(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnPlanarParams>("planar");
    const auto found = flat_receivers(input, {params.planes, params.min_area, params.tolerance}, "planar");
    const std::vector<GnFlattening> planes =
        lit_planes(input.samples.constants.cs_from_ws, *found, light_point_ws(input.light().shape)).planes;
    const TextureHandle image = input.graph.create(TextureDesc{.name = "visibility",
                                                               .format = VK_FORMAT_R32_SFLOAT,
                                                               .width = input.samples.width,
                                                               .height = input.samples.height});
    add_receivers(input, planes, image);
    add_casters(input, planes, image);
    return {image};
}

}  // namespace

namespace parts {

const Part& direct_planar() {
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

}  // namespace parts
}  // namespace gn
