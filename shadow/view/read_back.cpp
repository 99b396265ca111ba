// SPDX-License-Identifier: MIT
#include "shadow/view/read_back.h"

#include "base/stats.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"

#include <algorithm>

namespace gn {
namespace {

template <class T>
std::vector<T> as_vector(const std::vector<std::byte>& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

}  // namespace

CpuSamples read_samples(FrameGraph& graph, const ViewSamples& samples) {
    return {samples.width, samples.height, samples.camera, as_vector<vec4>(graph.download(samples.position)),
            as_vector<vec4>(graph.download(samples.normal))};
}

Image read_image(FrameGraph& graph, TextureHandle texture) {
    const TextureDesc& desc = graph.desc(texture);
    Image image;
    image.width = static_cast<int>(desc.width);
    image.height = static_cast<int>(desc.height);
    image.values = as_vector<float>(graph.download(texture));
    image.channels = static_cast<int>(image.values.size() / image.pixels());
    return image;
}

Image without_alpha(const Image& rgba) {
    Image rgb(rgba.width, rgba.height, 3);
    for (std::size_t i = 0; i < rgba.pixels(); ++i) {
        std::copy_n(rgba.values.begin() + static_cast<std::ptrdiff_t>(4 * i), 3,
                    rgb.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return rgb;
}

Image with_alpha(const Image& rgb) {
    Image rgba(rgb.width, rgb.height, 4, 1.0F);
    for (std::size_t i = 0; i < rgb.pixels(); ++i) {
        std::copy_n(rgb.values.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                    rgba.values.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
    return rgba;
}

void record_times(const GraphStatistics& statistics, FrameResult& result) {
    double shadow = 0;
    double frame = 0;
    result.pass_ms.resize(statistics.passes.size());
    for (std::size_t i = 0; i < statistics.passes.size(); ++i) {
        frame += statistics.passes[i].ms;
        shadow += statistics.passes[i].group == "shadow" ? statistics.passes[i].ms : 0.0;
        result.pass_ms[i].push_back(statistics.passes[i].ms);
    }
    result.shadow_ms.push_back(shadow);
    result.frame_ms.push_back(frame);
}

void finish_times(const GraphStatistics& statistics, FrameResult& result) {
    result.statistics = statistics;
    for (std::size_t i = 0; i < result.pass_ms.size(); ++i) {
        result.statistics.passes[i].ms = median(result.pass_ms[i]);
    }
}

namespace {

constexpr const char* unshadowed_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec3 n_ws = gbuffer_normal_texel(pixel).xyz;
    bool counted = position.w > 0.5 && gn_counted(u.light, position.xyz, n_ws);
#ifdef GN_ONLY_UNSHADOWED
    // The others keep what the technique gave them.
    if (!(counted && position.w > 1.5)) {
        return;
    }
#endif
    imageStore(visibility, pixel, vec4(counted ? 1.0 : 0.0));
}
)";

/// V = 1 for the samples that count: for all of them, or for those alone that receive no shadow.
void add_lit(const FrameInput& input, const char* name, const Visibility& result, bool all) {
    const ViewSamples& samples = input.samples;
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, samples);
    const VkFormat format = visibility_format(channels_of(input.graph, result.image));
    inputs.image(image_format(format), "writeonly", "image2D", "visibility", result.image);
    inputs.constant("GnViewConstants", "view", samples.constants);
    inputs.constant("GnLight", "light", input.whole_light().shape);
    const auto shader = compute_once(input.prepared, name, hashed(inputs), [&] {
        return (all ? "" : "#define GN_ONLY_UNSHADOWED\n") + include_line("shadow/view/view.glsl") + inputs.text() +
               unshadowed_text;
    });
    add_pixel_pass(input.graph, name, inputs, shader, samples.width, samples.height);
}

}  // namespace

Visibility add_no_shadow(const FrameInput& input) {
    Visibility result{create_visibility(input.graph, input.samples)};
    add_lit(input, "no shadow", result, true);
    return result;
}

void add_unshadowed(const FrameInput& input, const Visibility& visibility) {
    const auto& objects = input.scene.objects;
    if (std::any_of(objects.begin(), objects.end(), [](const Object& object) { return !object.receives; })) {
        add_lit(input, "unshadowed", visibility, false);
    }
}

}  // namespace gn
