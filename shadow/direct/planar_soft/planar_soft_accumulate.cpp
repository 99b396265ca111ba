// SPDX-License-Identifier: MIT
// Based on: Heckbert, Herf. Simulating Soft Shadows with Graphics Hardware. CMU-CS-97-104, 1997. [HH97]
// Departs from it: what is summed is what each view sample does not see of the light, not a texture of each receiver's
// radiance; the stencil keeps a sample from being darkened twice for one point.
#include "shadow/direct/planar_soft/planar_soft_passes.h"
#include "shadow/frame/frame.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/light_samples.h"

namespace gn {
namespace {

constexpr const char* hidden_text = R"(
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 p_ws = gbuffer_position_texel(pixel).xyz;
    bool above = dot(gbuffer_normal_texel(pixel).xyz, gn_to_light(u.one, p_ws)) > 0.0;
    result = above ? gn_point_weight(u.whole, u.one, p_ws) : 0.0;
)";

// [HH97] section 2.2: the mean over the light's points; one behind the surface shows it nothing.
constexpr const char* mean_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(visibility)))) {
        return;
    }
    vec4 p_ws = gbuffer_position_texel(pixel);
    vec3 n_ws = gbuffer_normal_texel(pixel).xyz;
    float v = 0.0;
    if (p_ws.w > 0.5 && gn_counted(u.whole, p_ws.xyz, n_ws)) {
        float all = 0.0;
        float above = 0.0;
        for (int i = 0; i < u.count; ++i) {
            float weight = gn_point_weight(u.whole, points[i], p_ws.xyz);
            all += weight;
            above += dot(n_ws, gn_to_light(points[i], p_ws.xyz)) > 0.0 ? weight : 0.0;
        }
        v = all > 0.0 ? clamp((above - hidden_texel(pixel).r) / all, 0.0, 1.0) : 1.0;
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

/// One plane under one point of the light.
struct Turn {
    ShaderInputs receivers, casters;
    std::uint32_t reference;
};

}  // namespace

Visibility add_accumulated(const FrameInput& input, const ReceiverPlanes& found, const GnPlanarSoftParams& params) {
    const GnLight& whole = input.whole_light().shape;
    const std::vector<GnLight> points = light_samples(input.light().shape, params.samples).points;
    const auto extra = [&](const GnLight& one) {
        ShaderInputs inputs;
        add_gbuffer(inputs, input.device, input.samples);
        inputs.constant("GnLight", "whole", whole).constant("GnLight", "one", one);
        return inputs;
    };
    const FlatCasters casters(input, {.includes = "#include \"shadow/scene/light_samples.h\"\n",
                                      .fragment = hidden_text,
                                      .extra = extra(whole),
                                      .blend = Blend::add});

    // Flatten the casters from every point onto every plane, and sum where they hide it.
    std::vector<Turn> turns;
    for (const GnLight& one : points) {
        const LitPlanes lit = lit_planes(input.samples.constants.cs_from_ws, found, light_point_ws(one));
        for (std::size_t i = 0; i < lit.planes.size(); ++i) {
            turns.push_back({flat_receiver_inputs(input, lit.planes[i]), casters.inputs(lit.planes[i], extra(one)),
                             lit.number[i] + 1});
        }
    }
    const ShaderInputs marked = flat_receiver_inputs(input, {});
    const TextureHandle hidden = input.graph.create(TextureDesc{.name = "planar-soft hidden",
                                                                .format = VK_FORMAT_R32_SFLOAT,
                                                                .width = input.samples.width,
                                                                .height = input.samples.height});
    input.graph.add_pass(
        "planar-soft: casters",
        [&](PassBuilder& pass) {
            pass.color(hidden, Load::clear);
            pass.depth_read_only(lent(input.samples.depth, "depth"), {0, 1, 0, 1}, 0);
            marked.declare(pass);
            casters.declare(pass);
        },
        [casters, turns = std::move(turns), mark = flat_receiver_pipeline(input, marked, true)](Recorder& r) {
            for (const Turn& turn : turns) {
                r.bind(*mark);
                r.stencil_reference(turn.reference);
                turn.receivers.set(r);
                r.draw(3);
                casters.record(r, turn.casters, turn.reference);
            }
        });

    // Take the mean.
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2D", "hidden", hidden)
        .image("r32f", "writeonly", "image2D", "visibility", result.image)
        .block("readonly buffer", "Points", "GnLight points[];", std::as_bytes(std::span(points)))
        .constant("GnLight", "whole", whole)
        .constant("int", "count", static_cast<int>(points.size()));
    const auto shader = compute_once(input.prepared, "planar-soft-mean.comp", hashed(inputs), [&] {
        return include_line("shadow/scene/light_samples.h") + inputs.text() + mean_text;
    });
    add_pixel_pass(input.graph, "planar-soft: mean", inputs, shader, input.samples.width, input.samples.height);
    return result;
}

}  // namespace gn
