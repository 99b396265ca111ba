// SPDX-License-Identifier: MIT
// Based on: Zhang. Forward Shadow Mapping. Eurographics Workshop on Rendering 1998. [Zha98]
#include "shadow/direct/forward/forward_passes.h"

#include "gpu/zeros_pass.h"
#include "shadow/frame/frame.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* samples_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    GnForwardSample s = GnForwardSample(vec2(0), 0.0, 0.0, vec2(0), vec2(0), 1.0, -2);
    GnReceiver receiver;
    if (read_sample(pixel, receiver)) {
        // Where two views overlap the first serves.
        int view = GN_CHOOSE(receiver, placement).first;
        GnProjected p = gn_project(receiver, views[view], u.bias);
        s.uv_ts = p.uv_ts;
        s.depth = p.depth;
        s.plane_slope = p.plane_slope;
        s.plane_fall = p.plane_fall;
        s.view = p.inside ? view : -1;
        vec2 at = p.uv_ts / p.texel_ts;
        vec4 bounds = floor(p.bounds_ts / p.texel_ts + 0.5);
        s.share = gn_forward_share(at.x, bounds.x, bounds.z, u.params.radius) *
                  gn_forward_share(at.y, bounds.y, bounds.w, u.params.radius);
        // What a plane falls within a texel, and a texel's width itself, are both as good as nothing.
        s.slack = u.params.tolerance * (p.texel_ws / p.metres_per_depth + length(p.plane_slope) * p.texel_ts);
    }
    samples[pixel.y * int(u.view.size.x) + pixel.x] = s;
}
)";

constexpr const char* resolve_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(visibility);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    int i = pixel.y * size.x + pixel.x;
    float v = clamp(float(light[i]) / (65536.0 * max(samples[i].share, 1.0e-3)), 0.0, 1.0);
    // What no view sees is lit; what does not count for the light is dark.
    v = samples[i].view == -1 ? 1.0 : samples[i].view == -2 ? 0.0 : v;
    imageStore(visibility, pixel, vec4(v));
}
)";

/// Bytes of GnForwardSample in scalar layout.
constexpr VkDeviceSize sample_bytes = 10 * sizeof(float);

VkDeviceSize pixels(const ViewSamples& samples) {
    return VkDeviceSize{samples.width} * samples.height;
}

}  // namespace

BufferHandle add_forward_samples(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                                 const GnForwardParams& params) {
    const ViewSamples& samples = input.samples;
    const BufferHandle buffer =
        input.graph.create(BufferDesc{.name = "forward samples", .bytes = pixels(samples) * sample_bytes});

    // Compose the shader as lookups do: the placement chooses, the bias moves.
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.buffer("writeonly buffer", "Samples", "GnForwardSample samples[];", buffer);
    inputs.constant("GnForwardParams", "params", params);
    const std::string defines = receiver_defines(recipe, views);
    const std::string functions = sample_functions(input, recipe, views);
    const Hasher key = hashed(inputs).text(defines).text(functions).text(views.part->id);
    const auto shader = compute_once(input.prepared, "forward-samples.comp", key, [&] {
        return defines + include_line("shadow/view/view.glsl") + placement_text(*views.part, recipe) +
               include_line("shadow/direct/forward/forward.glsl") + inputs.text() + functions + samples_text;
    });
    add_pixel_pass(input.graph, "forward: samples", inputs, shader, samples.width, samples.height);
    return buffer;
}

BufferHandle add_forward_splats(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                                TextureHandle depth, BufferHandle samples, const GnForwardParams& params) {
    const BufferHandle light =
        input.graph.create(BufferDesc{.name = "forward light", .bytes = pixels(input.samples) * sizeof(std::uint32_t)});
    add_zeros(input.graph, "forward: darkness", {light});
    ShaderInputs inputs;
    inputs.texture("sampler2DArray", "depth_map", depth);
    add_views(inputs, views);
    inputs.buffer("readonly buffer", "Samples", "GnForwardSample samples[];", samples);
    inputs.buffer("buffer", "Light", "uint light[];", light);
    inputs.constant("GnViewConstants", "view", input.samples.constants);
    inputs.constant("GnForwardParams", "params", params);
    const std::string defines = receiver_defines(recipe, views);
    const auto shader = compute_once(input.prepared, "forward-splat.comp", hashed(inputs).text(defines), [&] {
        return defines + include_line("shadow/view/view.glsl") + include_line("shadow/direct/forward/forward.glsl") +
               inputs.text() + include_line("shadow/direct/forward/forward_splat.glsl");
    });
    input.graph.add_pass(
        "forward: splat", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, count = views.views.size(), resolution = views.resolution](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            for (std::size_t view = 0; view < count; ++view) {
                // A whole layer covers any rectangle, also one that is chosen on the GPU.
                r.push_value(static_cast<std::int32_t>(view));
                r.dispatch_pixels(resolution, resolution);
            }
        });
    return light;
}

Visibility add_forward_resolve(const FrameInput& input, BufferHandle samples, BufferHandle light) {
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Samples", "GnForwardSample samples[];", samples);
    inputs.buffer("readonly buffer", "Light", "uint light[];", light);
    inputs.image("r32f", "writeonly", "image2D", "visibility", result.image);
    const auto shader = compute_once(input.prepared, "forward-resolve.comp", hashed(inputs), [&] {
        return include_line("shadow/direct/forward/forward.glsl") + inputs.text() + resolve_text;
    });
    add_pixel_pass(input.graph, "forward: resolve", inputs, shader, input.samples.width, input.samples.height);
    return result;
}

}  // namespace gn
