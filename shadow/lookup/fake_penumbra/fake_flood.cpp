// SPDX-License-Identifier: MIT
// Based on: Arvo, Hirvikorpi, Tyystjaervi. Approximate Soft Shadows with an Image-Space Flood-Fill Algorithm. Eurographics 2004.
// [AHT04]
// The fast variant: Rong, Tan. Jump Flooding in GPU with Applications to Voronoi Diagram and Distance Transform. I3D 2006. [RT06]
// Departs from them: an edge lies where two neighbours on one surface differ, and where two edges meet the one counts whose
// penumbra is nearer to its middle, so that the wider penumbra wins.
#include "shadow/lookup/fake_penumbra/fake_flood.h"

#include "shadow/frame/frame.h"
#include "shadow/lookup/fake_penumbra/fake_edge.glsl"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/sample_pass.h"

namespace gn {
namespace {

// What all passes know: an edge is a point and the spread of what casts it, below 0 for none.
constexpr const char* flood_head_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
bool counts(vec4 position, vec4 normal) { return position.w > 0.5 && gn_counted(u.whole, position.xyz, normal.xyz); }

// Halves of the penumbra's width between a sample and an edge.
float distance_to(vec3 p_ws, ivec2 pixel, vec4 edge) {
    if (edge.w < 0.0) {
        return 1.0e30;
    }
    GnExtentLight half_light = gn_fake_light(u.light, p_ws);
    vec2 q = gn_fake_beside(u.light, half_light, p_ws, edge.xyz);
    vec3 seen = gn_reproject(u.view.cs_from_ws, mat4(1.0), edge.xyz);
    float pixels = length(seen.xy * vec2(u.view.size.xy) - vec2(pixel) - 0.5);
    return gn_fake_distance(pixels, gn_fake_norm(half_light.square, q), edge.w, u.params.least, float(u.params.radius));
}

// Whether an edge goes on over the sample's surface.
bool on_surface(vec3 p_ws, vec4 normal, vec3 edge_ws) {
    float pixel_ws = gn_pixel_growth(u.view, normal.w) * length(u.view.right_ws.xyz);
    return abs(dot(normal.xyz, edge_ws - p_ws)) <= 0.5 * length(edge_ws - p_ws) + pixel_ws;
}
)";

constexpr const char* edges_text = R"(
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(u.view.size.xy);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    vec4 found = vec4(0.0, 0.0, 0.0, -1.0);
    float nearest = 1.0e30;
    vec2 own = texelFetch(shadows, pixel, 0).rg;
    for (int i = 0; i < 9 && counts(position, normal); ++i) {
        ivec2 beside = pixel + ivec2(i % 3, i / 3) - 1;
        if (any(lessThan(beside, ivec2(0))) || any(greaterThanEqual(beside, size))) {
            continue;
        }
        vec4 q = gbuffer_position_texel(beside);
        vec4 q_n = gbuffer_normal_texel(beside);
        vec2 other = texelFetch(shadows, beside, 0).rg;
        if ((own.x > 0.5) == (other.x > 0.5) || !counts(q, q_n) || dot(normal.xyz, q_n.xyz) < 0.9 ||
            !on_surface(position.xyz, normal, q.xyz)) {
            continue;
        }
        bool dark = own.x > 0.5;
        vec2 hidden = dark ? own : other;
        float before = gn_sssm_unpack(hidden.y / hidden.x);
        vec4 edge = vec4(0.5 * (position.xyz + q.xyz), gn_sssm_spread(u.light, dark ? position.xyz : q.xyz, before));
        float away = distance_to(position.xyz, pixel, edge);
        if (away < nearest) {
            nearest = away;
            found = edge;
        }
    }
    imageStore(result, pixel, found);
}
)";

constexpr const char* grow_text = R"(
layout(push_constant) uniform Push { int stride; };
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(u.view.size.xy);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    vec4 found = texelFetch(edges, pixel, 0);
    float nearest = distance_to(position.xyz, pixel, found);
    for (int i = 0; i < 9 && counts(position, normal); ++i) {
        ivec2 beside = pixel + stride * (ivec2(i % 3, i / 3) - 1);
        if (any(lessThan(beside, ivec2(0))) || any(greaterThanEqual(beside, size))) {
            continue;
        }
        vec4 edge = texelFetch(edges, beside, 0);
        if (edge.w < 0.0 || !on_surface(position.xyz, normal, edge.xyz)) {
            continue;
        }
        float away = distance_to(position.xyz, pixel, edge);
        if (away < nearest) {
            nearest = away;
            found = edge;
        }
    }
    imageStore(result, pixel, found);
}
)";

constexpr const char* shade_text = R"(
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    float v = 0.0;
    if (counts(position, normal)) {
        float shadow = texelFetch(shadows, pixel, 0).r;
        bool dark = shadow > 0.5;
        float x = min(distance_to(position.xyz, pixel, texelFetch(edges, pixel, 0)), 1.0);
        v = gn_unit(gn_fake_spreads(u.light, u.params) ? gn_fake_ramp(u.light.kind == uint(GN_LIGHT_RECTANGLE), dark ? -x : x)
                                                       : 1.0 - shadow);
    }
    imageStore(result, pixel, vec4(v));
}
)";

/// One pass over the picture. `edges` is invalid where the pass does not read any.
TextureHandle add_step(const FrameInput& input, const GnFakePenumbraParams& params, TextureHandle shadows,
                       TextureHandle edges, const char* name, const char* text, int stride) {
    const bool last = text == shade_text;
    const TextureHandle result = last ? create_visibility(input.graph, input.samples)
                                      : input.graph.create({.name = "shadow edges",
                                                            .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                            .width = input.samples.width,
                                                            .height = input.samples.height});
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    if (text != grow_text) {
        inputs.texture("sampler2D", "shadows", shadows);
    }
    if (edges.valid()) {
        inputs.texture("sampler2D", "edges", edges);
    }
    inputs.image(last ? image_format(visibility_format(1)) : "rgba32f", "writeonly", "image2D", "result", result);
    inputs.constant("GnViewConstants", "view", input.samples.constants)
        .constant("GnLight", "light", input.light().shape)
        .constant("GnLight", "whole", input.whole_light().shape)
        .constant("GnFakePenumbraParams", "params", params);
    const auto shader = compute_once(input.prepared, name, hashed(inputs), [&] {
        return expect_text(input.device) + channels_text(1) + include_line("shadow/view/view.glsl") +
               include_line("shadow/receiver/reprojection.glsl") + include_line("shadow/lookup/sssm/sssm.glsl") +
               include_line("shadow/lookup/fake_penumbra/fake_edge.glsl") + inputs.text() + flood_head_text + text;
    });
    input.graph.add_pass(
        name, [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, stride, size = uvec2(input.samples.width, input.samples.height)](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            if (stride > 0) {
                r.push_value(stride);
            }
            r.dispatch_pixels(size.x, size.y);
        });
    return result;
}

}  // namespace

std::vector<int> flood_strides(int radius, bool jump) {
    if (!jump) {
        return std::vector<int>(static_cast<std::size_t>(radius), 1);
    }
    std::vector<int> strides;
    int stride = 1;
    while (2 * stride <= radius) {
        stride *= 2;
    }
    for (; stride >= 1; stride /= 2) {
        strides.push_back(stride);
    }
    return strides;
}

Visibility add_fake_flood(const FrameInput& input, const GnFakePenumbraParams& params, TextureHandle shadows) {
    TextureHandle edges = add_step(input, params, shadows, {}, "shadow edges", edges_text, 0);
    // Of a light without extent every edge stays where it is.
    const bool spreads = glsl::gn_fake_spreads(input.light().shape, params);
    for (const int stride :
         spreads ? flood_strides(params.radius, params.form == GN_FAKE_JUMP_FLOOD) : std::vector<int>{}) {
        edges = add_step(input, params, {}, edges, "flood", grow_text, stride);
    }
    return {add_step(input, params, shadows, edges, "flooded penumbrae", shade_text, 0)};
}

}  // namespace gn
