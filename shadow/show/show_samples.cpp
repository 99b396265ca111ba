// SPDX-License-Identifier: MIT
// One pass over all view samples, through the views that serve them, into two images.
#include "shadow/receiver/sample_pass.h"
#include "shadow/show/show_passes.h"

namespace gn {
namespace {

TextureHandle create_image(const FrameInput& input, std::string name) {
    return input.graph.create({.name = std::move(name),
                               .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                               .width = input.samples.width,
                               .height = input.samples.height});
}

}  // namespace

SampleImages add_sample_pass(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                             const SamplePass& pass, std::span<const std::byte> member) {
    const SampleImages images{create_image(input, pass.first_name), create_image(input, pass.second_name)};
    const Part& placement = *views.part;
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.image("rgba32f", "writeonly", "image2D", "first", images.first);
    inputs.image("rgba32f", "writeonly", "image2D", "second", images.second);
    inputs.constant_bytes(pass.member_type, pass.member, member);
    const std::string text = "layout(local_size_x = 8, local_size_y = 8) in;\n" + receiver_defines(recipe, views) +
                             "#include \"shadow/view/view.glsl\"\n" + placement_text(placement, recipe) +
                             include_line("shadow/show/show.glsl") + inputs.text() +
                             sample_functions(input, recipe, views) + pass.text;
    const ComputeDesc shader{{ShaderKind::compute, fmt::format("{} {}", pass.name, placement.id), text}, {}};
    input.graph.add_pass(
        pass.name, [&](PassBuilder& builder) { inputs.declare(builder); },
        [shader, inputs, width = input.samples.width, height = input.samples.height](Recorder& r) {
            r.bind(shader);
            inputs.set(r);
            r.dispatch_pixels(width, height);
        });
    return images;
}

}  // namespace gn
