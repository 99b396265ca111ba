// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02] The depth that volumes are counted against, and what the count says of a sample.
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/masked_tree.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/geometry/volumes.glsl"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {

const std::string_view side_body = "#include \"shadow/geometry/volume_side.glsl\"\n";

std::string volume_shader(const ShaderInputs& inputs, std::string_view text) {
    return "#include \"shadow/geometry/volumes.glsl\"\n#include \"shadow/view/project.glsl\"\n" + inputs.text() +
           std::string(text);
}

ShaderInputs volume_side_inputs(const VolumeBuffers& buffers) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", buffers.positions)
        .buffer("readonly buffer", "Edges", "uvec2 edges[];", buffers.edges)
        .buffer("readonly buffer", "Sides", "uint sides[];", buffers.sides)
        .constant("GnVolumesFrame", "frame", buffers.frame);
    return inputs;
}

namespace {

constexpr const char* receiver_text = R"(
void main() {
    gl_FragDepth = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r;
}
)";

constexpr const char* border_text = R"(
layout(location = 0) flat in vec3 a_ws;
layout(location = 1) flat in vec3 b_ws;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 p_ws = gbuffer_position_texel(pixel);
    if (p_ws.w == 0.0 || !gn_volumes_touches(u.frame, p_ws.xyz, gbuffer_normal_texel(pixel).xyz, a_ws, b_ws)) {
        discard;
    }
    gl_FragDepth = min(gl_FragCoord.z * 1.00001, 1.0);
}
)";

constexpr const char* resolve_text = R"(
layout(location = 0) out float visibility;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 p_ws = gbuffer_position_texel(pixel);
    bool counted = p_ws.w > 0.0 && gn_counted(u.light, p_ws.xyz, gbuffer_normal_texel(pixel).xyz);
    if (KNOWN_V(pixel) <= 1.0) {
        visibility = KNOWN_V(pixel);
        return;
    }
    bool seen = counted && counts_texel(pixel).r == 0.0;
    visibility = seen && !HIDES_MASKED(p_ws.xyz, gbuffer_normal_texel(pixel).xyz) ? 1.0 : 0.0;
}
)";

/// What makes the receivers' depth: a copy, and what lifts it.
struct ReceiverPipelines {
    RasterDesc copy;
    std::array<RasterDesc, 2> border;  ///< at sides that count behind and before the sample
};

ReceiverPipelines receiver_pipelines(const ShaderInputs& inputs) {
    RasterDesc copy = fullscreen({ShaderKind::fragment, "volume-receiver.frag", volume_shader(inputs, receiver_text)});
    copy.depth_test = copy.depth_write = true;
    copy.depth_compare = VK_COMPARE_OP_ALWAYS;
    // The beginning of each side, where it may lie before a sample that touches the edge it hangs from.
    const auto border_of = [&](std::uint32_t before) {
        RasterDesc border;
        border.vertex = {ShaderKind::vertex, "volume-side.vert", volume_shader(inputs, side_body)};
        border.fragment = ShaderSource{ShaderKind::fragment, "volume-border.frag", volume_shader(inputs, border_text)};
        border.constants = {{0, 1U}, {3, before}};
        border.depth_test = border.depth_write = border.depth_clamp = true;
        border.depth_compare = VK_COMPARE_OP_GREATER;
        return sealed(std::move(border));
    };
    return {sealed(std::move(copy)), {border_of(0), border_of(1)}};
}

}  // namespace

TextureHandle add_receivers(const FrameInput& input, const VolumeBuffers& buffers, bool marks) {
    const ViewSamples& samples = input.samples;
    const TextureHandle lifted =
        input.graph.create(TextureDesc{.name = "volume receivers",
                                       .format = marks ? VK_FORMAT_D32_SFLOAT_S8_UINT : VK_FORMAT_D32_SFLOAT,
                                       .width = samples.width,
                                       .height = samples.height});
    ShaderInputs inputs = volume_side_inputs(buffers);
    add_gbuffer(inputs, input.device, samples);
    inputs.texture("sampler2D", "depth", lent(samples.depth, "depth"));
    const auto pipelines = made_once(input.prepared, "volume receivers", hashed(inputs).finish().low,
                                     [&] { return receiver_pipelines(inputs); });
    input.graph.add_pass(
        "volumes: receivers",
        [&](PassBuilder& pass) {
            pass.depth(lifted, Load::clear);
            inputs.declare(pass);
            pass.indirect(buffers.draws);
        },
        [inputs, pipelines, draws = buffers.draws](Recorder& r) {
            // Take the view samples' depth bit for bit, then lift what touches an edge before the side that hangs there.
            r.bind(pipelines->copy);
            inputs.set(r);
            r.draw(3);
            for (std::uint32_t before = 0; before < 2; ++before) {
                r.bind(pipelines->border[before]);
                r.draw_indirect(draws, (strips_draw + 4 * before) * sizeof(std::uint32_t));
            }
        });
    return lifted;
}

Visibility add_count_resolve(const FrameInput& input, TextureHandle counts, const CountResolve& resolve) {
    const ViewSamples& samples = input.samples;
    const TextureHandle image = input.graph.create(TextureDesc{
        .name = "visibility", .format = VK_FORMAT_R32_SFLOAT, .width = samples.width, .height = samples.height});
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, samples);
    inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2D", "counts", counts);
    inputs.constant("GnLight", "light", input.whole_light().shape);
    inputs.constant("vec4", "light_ws", light_point_ws(input.light().shape));
    const std::optional<MaskedTree> tree = resolve.masked ? MaskedTree::of(input) : std::nullopt;
    if (tree) {
        tree->add_to(inputs, input);
    }
    if (resolve.known.valid()) {
        inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2D", "known", resolve.known);
    }
    const auto shader = made_once(input.prepared, "volume resolve", hashed(inputs).finish().low, [&] {
        const std::string hides =
            tree ? MaskedTree::functions() + "#define HIDES_MASKED(p_ws, n_ws) masked_hides(p_ws, n_ws, u.light_ws)\n"
                 : "#define HIDES_MASKED(p_ws, n_ws) false\n";
        const std::string known =
            resolve.known.valid() ? "#define KNOWN_V(pixel) known_texel(pixel).r\n" : "#define KNOWN_V(pixel) 2.0\n";
        return sealed(fullscreen({ShaderKind::fragment, "volume-resolve.frag",
                                  std::string("#include \"shadow/scene/light.h\"\n") +
                                      (tree ? MaskedTree::types(input.device) : "") + inputs.text() + hides + known +
                                      resolve_text}));
    });
    input.graph.add_pass(
        "volumes: resolve",
        [&](PassBuilder& pass) {
            pass.color(image, Load::clear);
            inputs.declare(pass);
        },
        [inputs, shader](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.draw(3);
        });
    return {image};
}

}  // namespace gn
