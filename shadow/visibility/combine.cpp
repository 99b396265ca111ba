// SPDX-License-Identifier: MIT
#include "shadow/visibility/combine.h"

#include "gpu/shader_inputs.h"
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/pixel_pass.h"

#include <algorithm>

namespace gn {
namespace {

constexpr const char* combine_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(visibility)))) {
        imageStore(visibility, pixel, GN_COMBINE(GN_FIRST(texelFetch(first, pixel, 0)), GN_SECOND(texelFetch(second, pixel, 0))));
    }
}
)";

std::string define_of(Combine combine) {
    return combine == Combine::product ? "#define GN_COMBINE(a, b) (a * b)\n" : "#define GN_COMBINE(a, b) min(a, b)\n";
}

}  // namespace

Visibility add_combined(const FrameInput& input, const Visibility& first, const Visibility& second, Combine combine) {
    const uint channels = std::max(channels_of(input.graph, first.image), channels_of(input.graph, second.image));
    const Visibility result{create_visibility(input.graph, input.samples, channels), first.sides};
    // One channel stands for all three.
    const auto reader = [&](const char* name, const Visibility& v) {
        return fmt::format("#define {}(texel) (texel){}\n", name,
                           channels_of(input.graph, v.image) == 1 ? ".rrrr" : "");
    };
    ShaderInputs inputs;
    inputs.texture("sampler2D", "first", first.image).texture("sampler2D", "second", second.image);
    inputs.image(image_format(visibility_format(channels)), "writeonly", "image2D", "visibility", result.image);
    const Hasher key = hashed(inputs)
                           .value(combine)
                           .value(channels_of(input.graph, first.image))
                           .value(channels_of(input.graph, second.image));
    const auto shader = compute_once(input.prepared, "combine", key, [&] {
        return define_of(combine) + reader("GN_FIRST", first) + reader("GN_SECOND", second) + inputs.text() +
               combine_text;
    });
    add_pixel_pass(input.graph, "combine", inputs, shader, input.samples.width, input.samples.height);
    return result;
}

}  // namespace gn
