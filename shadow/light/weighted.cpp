// SPDX-License-Identifier: MIT
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
// Eq. 1.6, with weights: V of an area is the mean of the V of its points.
#include "shadow/light/weighted.h"

#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/sample_pass.h"

namespace gn {
namespace {

constexpr const char* begin_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec3 n_ws = gbuffer_normal_texel(pixel).xyz;
    bool counted = position.w > 0.5 && gn_counted(u.light, position.xyz, n_ws);
)";

// Adds w V and w of one light to the sums.
constexpr const char* add_text = R"(
    float weight = counted ? GN_WEIGHT(u.light, u.one, position.xyz, pixel, u.index, u.count) : 0.0;
    bool above = dot(n_ws, gn_to_light(u.one, position.xyz)) > 0.0;
    GN_V v = above ? GN_V_OF(texelFetch(visibility, pixel, 0)) : GN_V(0.0);
    vec4 before = u.index > 0 ? imageLoad(sums, pixel) : vec4(0.0);
    imageStore(sums, pixel, before + (weight > 0.0 ? weight * GN_SUM(v) : vec4(0.0)));
}
)";

constexpr const char* mean_text = R"(
    vec4 sum = imageLoad(sums, pixel);
    GN_V v = GN_SUM_WEIGHT(sum) > 0.0 ? GN_V_OF(sum) / GN_SUM_WEIGHT(sum) : GN_V(1.0);
    imageStore(visibility, pixel, counted ? GN_V_TEXEL(gn_unit(v)) : vec4(0.0));
}
)";

/// Sums hold w V and, behind it, w.
VkFormat sums_format(uint channels) {
    return channels == 1 ? VK_FORMAT_R32G32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

std::string sums_text(uint channels) {
    return channels_text(channels) +
           (channels == 1 ? "#define GN_SUM(v) vec4(v, 1.0, 0.0, 0.0)\n#define GN_SUM_WEIGHT(sum) (sum).g\n"
                          : "#define GN_SUM(v) vec4(v, 1.0)\n#define GN_SUM_WEIGHT(sum) (sum).a\n");
}

/// A pass over the view samples; its shader has u.view, u.light and what `inputs` adds, and `prologue` composes what stands
/// before them.
template <class Prologue>
void add_pass(const FrameInput& input, const char* name, ShaderInputs inputs, Prologue prologue, const char* text) {
    add_gbuffer(inputs, input.device, input.samples);
    const auto shader = compute_once(input.prepared, name, hashed(inputs), [&] {
        return expect_text(input.device) + include_line("shadow/view/view.glsl") + prologue() + inputs.text() +
               begin_text + text;
    });
    input.graph.add_pass(
        name, [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, size = uvec2(input.samples.width, input.samples.height)](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch_pixels(size.x, size.y);
        });
}

ShaderInputs inputs_of(const FrameInput& input) {
    ShaderInputs inputs;
    inputs.constant("GnViewConstants", "view", input.samples.constants);
    inputs.constant("GnLight", "light", input.whole_light().shape);
    return inputs;
}

void add_one(const FrameInput& one, const Recipe& recipe, int index, int count, TextureHandle visibility,
             TextureHandle sums) {
    const Part& part = *recipe.light;
    ShaderInputs inputs = inputs_of(one);
    inputs.constant("GnLight", "one", one.light().shape)
        .constant("int", "index", index)
        .constant("int", "count", count);
    inputs.constant_bytes(part.params_type, "params", recipe.block(part).bytes());
    inputs.texture("sampler2D", "visibility", visibility);
    const uint channels = channels_of(one.graph, visibility);
    inputs.image(image_format(sums_format(channels)), "", "image2D", "sums", sums);
    const auto prologue = [&] {
        return sums_text(channels) + include_line(part.glsl) +
               fmt::format(
                   "#define GN_WEIGHT(light, one, p_ws, pixel, index, count) "
                   "gn_{}_weight(light, one, p_ws, pixel, index, count, u.params)\n",
                   identifier(part.id));
    };
    add_pass(one, "light: add", std::move(inputs), prologue, add_text);
}

}  // namespace

Visibility add_weighted(const FrameInput& input, const Recipe& recipe,
                        const std::function<Visibility(const FrameInput&)>& serve) {
    FrameGraph& graph = input.graph;
    const auto lights = std::make_shared<const std::vector<Light>>(recipe.light->split(input.light(), recipe));
    GN_CHECK(!lights->empty());

    // Serve light after light, each with what the one before has done with.
    TextureHandle sums;
    uint channels = 1;
    graph.begin_rounds();
    for (std::size_t i = 0; i < lights->size(); ++i) {
        graph.next_round();
        FrameInput one = input;
        one.source = &lights->at(i);
        one.parent = &input.light();
        one.history = nullptr;
        const Visibility served = serve(one);
        if (!sums.valid()) {
            channels = channels_of(graph, served.image);
            sums = graph.create({.name = "light sums",
                                 .format = sums_format(channels),
                                 .width = input.samples.width,
                                 .height = input.samples.height});
        }
        add_one(one, recipe, static_cast<int>(i), static_cast<int>(lights->size()), served.image, sums);
    }
    graph.end_rounds();

    // Passes point to the lights: they live as long as the graph.
    graph.hold(lights);
    Visibility result{create_visibility(graph, input.samples, channels)};
    ShaderInputs inputs = inputs_of(input);
    inputs.image(image_format(sums_format(channels)), "readonly", "image2D", "sums", sums);
    inputs.image(image_format(visibility_format(channels)), "writeonly", "image2D", "visibility", result.image);
    add_pass(
        input, "light: mean", std::move(inputs), [&] { return sums_text(channels); }, mean_text);
    return result;
}

}  // namespace gn
