// SPDX-License-Identifier: MIT
// Based on: Chan, Durand. Rendering Fake Soft Shadows with Smoothies. EGSR 2003. [CD03]
#include "shadow/casters/fins.h"

#include "shadow/casters/caster_draw.h"
#include "shadow/frame/frame.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/seen_light.glsl"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* fin_text = R"(
layout(push_constant) uniform Push { int index; };
layout(location = 0) in vec3 p_ws;
layout(location = 1) flat in vec3 a_ws;
layout(location = 2) flat in vec3 b_ws;
layout(location = 3) flat in float unit_ws;
void main() {
    vec3 along_ws = b_ws - a_ws;
    float length2 = dot(along_ws, along_ws);
    float t = length2 > 0.0 ? clamp(dot(p_ws - a_ws, along_ws) / length2, 0.0, 1.0) : 0.0;
    vec3 edge_ws = a_ws + along_ws * t;
    float off = distance(p_ws, edge_ws) / max(unit_ws, 1.0e-30);
    float edge_depth = dot(views[index].depth_from_ws, vec4(edge_ws, 1.0));
    ivec3 texel = ivec3(gl_FragCoord.xy, views[index].layer);
)";

constexpr const char* resolve_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    float v = 0.0;
    GnReceiver receiver;
    if (read_sample(pixel, receiver)) {
        v = 1.0;
        GnLightView view = views[GN_CHOOSE(receiver, placement).first];
        GnProjected p = gn_project(receiver, view, u.bias);
        if (p.inside) {
            ivec2 texel = ivec2(floor(p.uv_ts / p.texel_ts));
            vec2 centre_ts = (vec2(texel) + 0.5) * p.texel_ts;
            float occluder = texelFetch(depth_map, ivec3(texel, view.layer), 0).r;
            vec4 fin = texelFetch(fins, ivec3(texel, view.layer), 0);
            v = gn_depth_at(p, centre_ts, u.bias) > occluder ? 0.0 : (GN_FIN_LIGHT);
        }
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

ShaderInputs fin_inputs(const FrameInput& input, const VolumeBuffers& buffers, const LightViews& views,
                        const ShaderInputs& extra) {
    const GnLight& light = input.light().shape;
    const vec2 half_size = glsl::gn_light_half_size(light);
    const bool round = light.kind != GN_LIGHT_RECTANGLE;
    ShaderInputs inputs = view_list(views);
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", input.handles.positions)
        .buffer("readonly buffer", "Edges", "uvec2 edges[];", buffers.edges)
        .buffer("readonly buffer", "Sides", "uint sides[];", buffers.sides)
        .constant("vec4", "light_ws", light_point_ws(light))
        .constant("vec4", "x_ws", vec4(vec3(light.right_ws) * half_size.x, 0))
        .constant("vec4", "y_ws", vec4(vec3(light.up_ws) * half_size.y, 0))
        .constant("vec4", "round_ws", round ? vec4(half_size.x) : vec4(0))
        .add(extra);
    return inputs;
}

}  // namespace

void add_fins(const FrameInput& input, const VolumeBuffers& buffers, const LightViews& views, const FinPass& pass,
              TextureHandle image, ClearValue clear) {
    const ShaderInputs inputs = fin_inputs(input, buffers, views, pass.extra);
    const std::uint64_t key = hashed(inputs).text(pass.name).text(pass.includes).text(pass.fragment).finish().low;
    const auto pipeline = made_once(input.prepared, "fins", key, [&] {
        const std::string head = include_line("shadow/light_view.h") + std::string(pass.includes) + inputs.text();
        RasterDesc desc;
        desc.vertex = {ShaderKind::vertex, "fin.vert", head + include_line("shadow/casters/fins.glsl")};
        desc.fragment = ShaderSource{ShaderKind::fragment, "fin.frag",
                                     fmt::format("{}\nlayout(location = 0) out {} result;\n{}{}}}\n", head, pass.result,
                                                 fin_text, pass.fragment)};
        desc.blend = Blend::min;
        return sealed(desc);
    });
    std::vector<bool> begun(views.layers, false);
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        const auto layer = static_cast<std::uint32_t>(views.views[i].layer);
        input.graph.add_pass(
            std::string(pass.name),
            [&](PassBuilder& builder) {
                builder.color(image, begun[layer] ? Load::keep : Load::clear, clear, one_layer(layer));
                builder.indirect(buffers.draws);
                inputs.declare(builder);
            },
            [inputs, pipeline, draws = buffers.draws, view = views.views[i],
             index = static_cast<std::int32_t>(i)](Recorder& r) {
                set_viewport(r, view);
                r.bind(*pipeline);
                inputs.set(r);
                r.push_value(index);
                r.draw_indirect(draws, VkDeviceSize{strips_draw} * sizeof(std::uint32_t));
            });
        begun[layer] = true;
    }
}

Visibility add_fin_resolve(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle depth,
                           TextureHandle fins, const FinLookup& lookup) {
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.texture("sampler2DArray", "depth_map", depth)
        .texture("sampler2DArray", "fins", fins)
        .image("r32f", "writeonly", "image2D", "visibility", result.image);
    const std::string defines = receiver_defines(recipe, views);
    const std::string functions = sample_functions(input, recipe, views);
    const Hasher key = hashed(inputs).text(defines).text(functions).text(views.part->id).text(lookup.light);
    const auto shader = compute_once(input.prepared, lookup.name, key, [&] {
        return defines + include_line("shadow/view/view.glsl") + placement_text(*views.part, recipe) + inputs.text() +
               functions + fmt::format("#define GN_FIN_LIGHT {}\n", lookup.light) + resolve_text;
    });
    add_pixel_pass(input.graph, std::string(lookup.name), inputs, shader, input.samples.width, input.samples.height);
    return result;
}

std::string refuses_fins(std::string_view part, const Recipe& recipe) {
    return recipe.placement != nullptr && recipe.placement->bends
               ? fmt::format(
                     "direct '{}' draws straight fins into its views and placement '{}' bends them; use auto or cube",
                     part, recipe.placement->id)
               : "";
}

}  // namespace gn
