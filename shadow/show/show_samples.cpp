// SPDX-License-Identifier: MIT
// One pass over all view samples, through the views that serve them, into two images.
#include "shadow/receiver/sample_pass.h"
#include "shadow/show/show_passes.h"

namespace gn {
namespace {

constexpr const char* images_text = R"(
layout(binding = 4, rgba32f) uniform writeonly image2D first;
layout(binding = 5, rgba32f) uniform writeonly image2D second;
)";

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
    const std::string text = receiver_defines(recipe, views) + "#include \"shadow/view/view.glsl\"\n" +
                             include_line(placement.glsl) + include_line("shadow/show/show.glsl") +
                             sample_bindings(pass.member) + sample_functions(placement) + images_text + pass.text;
    const ComputeDesc shader{{ShaderKind::compute, fmt::format("{} {}", pass.name, placement.id), text}, {}};
    std::vector<std::byte> bytes = sample_constants(input, recipe);
    bytes.insert(bytes.end(), member.begin(), member.end());

    const ViewSamples& samples = input.samples;
    input.graph.add_pass(
        pass.name,
        [&](PassBuilder& builder) {
            declare_samples(builder, samples, views);
            builder.storage_write(images.first);
            builder.storage_write(images.second);
        },
        [shader, bytes, samples, views, images](Recorder& r) {
            r.bind(shader);
            set_samples(r, samples, views);
            r.set_storage("first", images.first);
            r.set_storage("second", images.second);
            r.set_bytes("u", bytes);
            r.dispatch_pixels(samples.width, samples.height);
        });
    return images;
}

}  // namespace gn
