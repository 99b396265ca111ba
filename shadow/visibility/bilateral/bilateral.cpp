// SPDX-License-Identifier: MIT
// A joint bilateral filter of visibility in screen space: it averages along surfaces and never across their borders.
//
// Based on: Petschnigg, Szeliski, Agrawala, Cohen, Hoppe, Toyama. Digital Photography with Flash and No-Flash Image
// Pairs. SIGGRAPH 2004. [PSA04]
// Based on: Pham, van Vliet. Separable Bilateral Filtering for Fast Video Preprocessing. ICME 2005. [PV05]
#include "shadow/visibility/bilateral/bilateral.h"

#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/sample_pass.h"

namespace gn::parts::bilateral {
namespace {

constexpr const char* filter_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { ivec2 axis; };
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(u.view.size.xy);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    if (position.w < 0.5 || !gn_counted(u.light, position.xyz, normal.xyz)) {
        imageStore(filtered, pixel, vec4(0.0));
        return;
    }
    // The width of a pixel at the sample.
    float pixel_ws = gn_pixel_growth(u.view, normal.w) * length(u.view.right_ws.xyz);

    // Average how much what counts for the light differs from the sample, by closeness on screen and in space: where all is
    // the same nothing changes, however a device divides.
    GN_V own = GN_V_OF(texelFetch(noisy, pixel, 0));
    GN_V sum = GN_V(0.0);
    float weights = 1.0;
    for (int i = -u.params.radius; i <= u.params.radius; ++i) {
        ivec2 neighbour = pixel + i * axis;
        if (i == 0 || any(lessThan(neighbour, ivec2(0))) || any(greaterThanEqual(neighbour, size))) {
            continue;
        }
        vec4 q = gbuffer_position_texel(neighbour);
        vec3 q_n = gbuffer_normal_texel(neighbour).xyz;
        if (q.w < 0.5 || !gn_counted(u.light, q.xyz, q_n)) {
            continue;
        }
        float weight = gn_bilateral_spatial(abs(i), u.params.radius) *
                       gn_bilateral_range(position.xyz, normal.xyz, pixel_ws, q.xyz, q_n, u.params);
        sum += weight * (GN_V_OF(texelFetch(noisy, neighbour, 0)) - own);
        weights += weight;
    }
    imageStore(filtered, pixel, GN_V_TEXEL(gn_unit(own + sum / weights)));
}
)";

/// One direction of the filter.
TextureHandle add_direction(const FrameInput& input, const GnBilateralParams& params, TextureHandle noisy, ivec2 axis) {
    const ViewSamples& samples = input.samples;
    const uint channels = channels_of(input.graph, noisy);
    const TextureHandle filtered = create_visibility(input.graph, samples, channels);
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, samples);
    inputs.texture("sampler2D", "noisy", noisy);
    inputs.image(image_format(visibility_format(channels)), "writeonly", "image2D", "filtered", filtered);
    inputs.constant("GnViewConstants", "view", samples.constants)
        .constant("GnLight", "light", input.light().shape)
        .constant("GnBilateralParams", "params", params);
    const auto shader = compute_once(input.prepared, "bilateral", hashed(inputs), [&] {
        return expect_text(input.device) + channels_text(channels) + include_line("shadow/view/view.glsl") +
               include_line("shadow/visibility/bilateral/bilateral.glsl") + inputs.text() + filter_text;
    });
    input.graph.add_pass(
        axis.x != 0 ? "bilateral x" : "bilateral y", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, axis, size = uvec2(samples.width, samples.height)](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.push_value(axis);
            r.dispatch_pixels(size.x, size.y);
        });
    return filtered;
}

Visibility add_bilateral(const FrameInput& input, const Recipe& recipe, const Visibility& noisy) {
    const auto params = recipe.of<GnBilateralParams>("bilateral");
    if (params.radius == 0) {
        return noisy;
    }
    const TextureHandle along_x = add_direction(input, params, noisy.image, ivec2(1, 0));
    return {add_direction(input, params, along_x, ivec2(0, 1))};
}

}  // namespace
}  // namespace gn::parts::bilateral

namespace gn::parts {

const Part& visibility_bilateral() {
    using namespace bilateral;
    static const Part part = [] {
        Part p;
        p.id = "bilateral";
        p.stage = Stage::visibility;
        p.title = "Joint bilateral filter";
        p.citation = "PSA04";
        p.params = param_table<GnBilateralParams>({
            GN_PARAM(GnBilateralParams, radius, integer, 0, 64, "pixels",
                     "Reach of the filter: less noise and softer edges, cost grows in proportion."),
            GN_PARAM(GnBilateralParams, plane, real, 0.01, 1000, "pixels",
                     "Distance from a sample's plane, in widths of its pixel, at which neighbours stop counting: "
                     "smoother curved surfaces, bleeding over small steps."),
            GN_PARAM(GnBilateralParams, normal, real, 0, 1024, "",
                     "Exponent of the cosine between normals: surfaces of fewer directions are mixed."),
        });
        p.params_type = "GnBilateralParams";
        p.glsl = "shadow/visibility/bilateral/bilateral.glsl";
        p.add_visibility = add_bilateral;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
