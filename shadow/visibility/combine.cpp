// SPDX-License-Identifier: MIT
#include "shadow/visibility/combine.h"

#include "gpu/shader_inputs.h"
#include "shadow/frame/frame.h"

namespace gn {
namespace {

constexpr const char* main_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(visibility)))) {
        imageStore(visibility, pixel, GN_COMBINE(texelFetch(mapped, pixel, 0), texelFetch(direct, pixel, 0)));
    }
}
)";

std::string define_of(Combine combine) {
    return combine == Combine::product ? "#define GN_COMBINE(a, b) (a * b)\n" : "#define GN_COMBINE(a, b) min(a, b)\n";
}

}  // namespace

Visibility add_combined(const FrameInput& input, const Visibility& mapped, const Visibility& direct, Combine combine) {
    const Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    inputs.texture("sampler2D", "mapped", mapped.image).texture("sampler2D", "direct", direct.image);
    inputs.image("r32f", "writeonly", "image2D", "visibility", result.image);
    const ComputeDesc shader{{ShaderKind::compute, "combine", define_of(combine) + inputs.text() + main_text}, {}};
    input.graph.add_pass(
        "combine", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, size = uvec2(input.samples.width, input.samples.height)](Recorder& r) {
            r.bind(shader);
            inputs.set(r);
            r.dispatch_pixels(size.x, size.y);
        });
    return result;
}

}  // namespace gn
