// SPDX-License-Identifier: MIT
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, section 7.1. 2018. [AHH18]
// The hard shadow on planes: receivers by number in the stencil, then casters, dark once.
#include "shadow/geometry/flattened.h"
#include "shadow/receiver/sample_pass.h"

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

}  // namespace

Visibility add_flat_shadow(const FrameInput& input, const ReceiverPlanes& found) {
    const std::vector<GnFlattening> planes =
        lit_planes(input.samples.constants.cs_from_ws, found, light_point_ws(input.light().shape)).planes;
    const TextureHandle image = input.graph.create(TextureDesc{.name = "visibility",
                                                               .format = VK_FORMAT_R32_SFLOAT,
                                                               .width = input.samples.width,
                                                               .height = input.samples.height});
    add_receivers(input, planes, image);
    add_casters(input, planes, image);
    return {image};
}

}  // namespace gn
