// SPDX-License-Identifier: MIT
#include "shadow/lookup/backprojection/emission.h"

#include "gpu/shader_inputs.h"
#include "shadow/frame/frame.h"
#include "shadow/lookup/backprojection/emission.glsl"
#include "shadow/receiver/sample_pass.h"

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

/// Samples along a side of a cell.
constexpr int samples = 16;

constexpr const char* emission_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < u.samples * u.samples; ++i) {
        vec2 x = gn_back_in_cell(cell, ivec2(i % u.samples, i / u.samples), u.samples);
        sum += textureLod(picture, gn_emission_place(u.light, x), u.lod).rgb;
    }
    imageStore(sent, ivec3(cell, 0), vec4(sum / float(u.samples * u.samples), 1.0));
}
)";

}  // namespace

bool shows_picture(const FrameInput& input) {
    return input.parent == nullptr && shown_picture(input.scene, input.light().shape) != nullptr;
}

TextureHandle add_emission(const FrameInput& input) {
    const Light& light = input.light();
    const auto index = static_cast<std::size_t>(gn_emission_texture(light.shape));
    const Image8& picture = input.scene.textures[index].image;
    // The coarsest level of which a cell is still as many texels wide as it is sampled.
    const auto side = static_cast<float>(std::max(picture.width, picture.height));
    const float lod = std::max(std::floor(std::log2(side / static_cast<float>(glsl::gn_back_cells * samples))), 0.0F);

    const TextureHandle sent = input.graph.create({.name = "emission",
                                                   .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                   .width = glsl::gn_back_cells,
                                                   .height = glsl::gn_back_cells});
    ShaderInputs inputs;
    inputs.texture("sampler2D", "picture", input.handles.textures[index], linear());
    inputs.image("rgba32f", "writeonly", "image2DArray", "sent", sent);
    inputs.constant("GnLight", "light", light.shape).constant("float", "lod", lod).constant("int", "samples", samples);
    const auto shader = compute_once(input.prepared, "emission", hashed(inputs), [&] {
        return include_line("shadow/lookup/backprojection/emission.glsl") + inputs.text() + emission_text;
    });
    input.graph.add_pass(
        "emission", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch_pixels(glsl::gn_back_cells, glsl::gn_back_cells);
        });
    return sent;
}

}  // namespace gn
