// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02] The raster passes of a light: counting, and what the count says.
// Departs from it: the count is a sum of blended floats, exact to 16 million, where eight bits of stencil wrap at 256.
#include "gpu/shader_inputs.h"
#include "shadow/direct/volumes/volumes.glsl"
#include "shadow/direct/volumes/volumes_passes.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {

namespace {

// The vertex shaders clip at the near plane themselves: depth clamping, which keeps what lies beyond the far plane, turns
// the fixed clipping off.
constexpr const char* side_text = R"(
layout(constant_id = 0) const int STRIP = 0;
layout(location = 0) flat out vec3 a_ws;
layout(location = 1) flat out vec3 b_ws;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    // From outside the side is a, a at infinity, b at infinity, b; where both points at infinity are one, its first
    // triangle is nothing.
    uint corners = STRIP != 0 ? 6u : gn_volumes_corners(u.frame);
    uint side = sides[uint(gl_VertexIndex) / corners];
    uint corner = uint(gl_VertexIndex) % corners + 6u - corners;
    uvec2 edge = edges[side >> 1];
    a_ws = positions[edge.x];
    b_ws = positions[edge.y];
    bool turned = (side & 1u) != 0u;
    bool second = corner == 2u || corner >= 4u;
    bool far = corner == 1u || corner == 2u || corner == 4u;
    vec3 p_ws = second != turned ? b_ws : a_ws;
    vec4 far_ws = gn_volumes_extrude(p_ws, u.frame.light_ws, u.frame.reach);
    if (STRIP != 0) {
        far_ws = gn_volumes_strip(u.frame, p_ws, gn_volumes_away(p_ws, u.frame.light_ws));
    }
    gl_Position = gn_view_position(u.frame.cs_from_ws, far ? far_ws : vec4(p_ws, 1.0));
    gl_ClipDistance[0] = gl_Position.w - gl_Position.z;
}
)";

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

// An opaque cap's vertex, as it is or at the far end.
constexpr const char* opaque_text = R"(
layout(constant_id = 2) const int FAR = 0;
layout(location = 0) in vec3 in_position_ws;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    vec4 corner_ws = FAR != 0 ? gn_volumes_extrude(in_position_ws, u.frame.light_ws, u.frame.reach)
                              : vec4(in_position_ws, 1.0);
    gl_Position = gn_view_position(u.frame.cs_from_ws, corner_ws);
    gl_ClipDistance[0] = gl_Position.w - gl_Position.z;
}
)";

constexpr const char* masked_text = R"(
layout(constant_id = 1) const int TURNED = 0;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    uint corners = gn_volumes_has_far_cap(u.frame) ? 6u : 3u;
    uint slot = uint(gl_VertexIndex) / corners;
    uint corner = uint(gl_VertexIndex) % corners;
    uint t = caps[TURNED != 0 ? u.frame.triangles - 1u - slot : u.frame.opaque_triangles + slot];
    // The near cap keeps the order of the triangle's corners, the far cap is its mirror image at infinity.
    bool far = corner >= 3u;
    vec3 p_ws = positions[indices[3u * t + (far ? (6u - corner) % 3u : corner)]];
    vec4 corner_ws = far ? gn_volumes_extrude(p_ws, u.frame.light_ws, u.frame.reach) : vec4(p_ws, 1.0);
    gl_Position = gn_view_position(u.frame.cs_from_ws, corner_ws);
    gl_ClipDistance[0] = gl_Position.w - gl_Position.z;
    // A triangle with one side lies before a sample only where it shows its back, which nobody sees: elsewhere it counts as
    // every opaque cap does.
    if ((owners[t] & 6u) == 2u &&
        gn_volumes_side(positions[indices[3u * t]], positions[indices[3u * t + 1u]], positions[indices[3u * t + 2u]],
                        u.frame.eye_ws) > 0) {
        gl_Position.z = 0.0;
    }
}
)";

constexpr const char* count_text = R"(
layout(constant_id = 1) const int TURNED = 0;
layout(constant_id = 2) const int FAR = 0;
layout(location = 0) out float count;
void main() {
    // What lies behind the sample: +1 where a ray leaves the volume, -1 where it enters. The far end is a mirror image.
    count = gl_FrontFacing == (TURNED == FAR) ? -1.0 : 1.0;
}
)";

constexpr const char* resolve_text = R"(
layout(location = 0) out float visibility;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 p_ws = gbuffer_position_texel(pixel);
    bool counted = p_ws.w > 0.0 && gn_counted(u.light, p_ws.xyz, gbuffer_normal_texel(pixel).xyz);
    visibility = counted && counts_texel(pixel).r == 0.0 ? 1.0 : 0.0;
}
)";

std::string with(const ShaderInputs& inputs, const char* text) {
    return "#include \"shadow/direct/volumes/volumes.glsl\"\n#include \"shadow/view/project.glsl\"\n" + inputs.text() +
           text;
}

ShaderInputs side_inputs(const FrameInput& input, const VolumeBuffers& buffers) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", input.handles.positions)
        .buffer("readonly buffer", "Edges", "uvec2 edges[];", buffers.edges)
        .buffer("readonly buffer", "Sides", "uint sides[];", buffers.sides)
        .constant("GnVolumesFrame", "frame", buffers.frame);
    return inputs;
}

// Z-fail: what lies at or behind the sample counts. Depth is reversed, so that this is LESS_OR_EQUAL; opaque caps always
// count (volumes.md derives both).
RasterDesc count_pipeline(const char* name, std::string text, VkCompareOp compare, bool turned, bool far) {
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, name, std::move(text)};
    desc.fragment = ShaderSource{ShaderKind::fragment, "volume-count.frag", count_text};
    desc.constants = {{1, turned ? 1U : 0U}, {2, far ? 1U : 0U}};
    desc.blend = Blend::add;
    desc.depth_test = desc.depth_clamp = true;
    desc.depth_compare = compare;
    return desc;
}

RasterDesc opaque_pipeline(std::string text, bool turned, bool far) {
    RasterDesc desc = count_pipeline("volume-cap.vert", std::move(text), VK_COMPARE_OP_ALWAYS, turned, far);
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
    desc.vertex_stride = sizeof(vec3);
    return sealed(std::move(desc));
}

/// What counts: the sides, and by whether it is turned over each cap.
struct CountPipelines {
    RasterDesc sides;
    std::array<RasterDesc, 2> near, far, masked;
};

CountPipelines count_pipelines(const ShaderInputs& inputs) {
    constexpr VkCompareOp behind = VK_COMPARE_OP_LESS_OR_EQUAL;
    CountPipelines made{
        sealed(count_pipeline("volume-side.vert", with(inputs, side_text), behind, false, false)), {}, {}, {}};
    for (std::size_t turned = 0; turned < 2; ++turned) {
        made.near[turned] = opaque_pipeline(with(inputs, opaque_text), turned == 1, false);
        made.far[turned] = opaque_pipeline(with(inputs, opaque_text), turned == 1, true);
        made.masked[turned] =
            sealed(count_pipeline("volume-masked.vert", with(inputs, masked_text), behind, turned == 1, false));
    }
    return made;
}

/// What makes the receivers' depth: a copy, and what lifts it.
struct ReceiverPipelines {
    RasterDesc copy, border;
};

ReceiverPipelines receiver_pipelines(const ShaderInputs& inputs) {
    RasterDesc copy = fullscreen({ShaderKind::fragment, "volume-receiver.frag", with(inputs, receiver_text)});
    copy.depth_test = copy.depth_write = true;
    copy.depth_compare = VK_COMPARE_OP_ALWAYS;
    // The beginning of each side, where it may lie before a sample that touches the edge it hangs from.
    RasterDesc border;
    border.vertex = {ShaderKind::vertex, "volume-side.vert", with(inputs, side_text)};
    border.fragment = ShaderSource{ShaderKind::fragment, "volume-border.frag", with(inputs, border_text)};
    border.constants = {{0, 1U}};
    border.depth_test = border.depth_write = border.depth_clamp = true;
    border.depth_compare = VK_COMPARE_OP_GREATER;
    return {sealed(std::move(copy)), sealed(std::move(border))};
}

}  // namespace

TextureHandle add_receivers(const FrameInput& input, const VolumeBuffers& buffers) {
    const ViewSamples& samples = input.samples;
    const TextureHandle lifted = input.graph.create(TextureDesc{
        .name = "volume receivers", .format = VK_FORMAT_D32_SFLOAT, .width = samples.width, .height = samples.height});
    ShaderInputs inputs = side_inputs(input, buffers);
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
            r.bind(pipelines->border);
            r.draw_indirect(draws, strips_draw * sizeof(std::uint32_t));
        });
    return lifted;
}

TextureHandle add_counts(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers) {
    const TextureHandle counts = input.graph.create(TextureDesc{.name = "volume counts",
                                                                .format = VK_FORMAT_R32_SFLOAT,
                                                                .width = input.samples.width,
                                                                .height = input.samples.height});
    ShaderInputs inputs = side_inputs(input, buffers);
    inputs.buffer("readonly buffer", "Indices", "uint indices[];", input.handles.indices)
        .buffer("readonly buffer", "Caps", "uint caps[];", buffers.caps)
        .buffer("readonly buffer", "Owners", "uint owners[];", buffers.owners);
    const auto pipelines = made_once(input.prepared, "volume counts", hashed(inputs).finish().low,
                                     [&] { return count_pipelines(inputs); });
    input.graph.add_pass(
        "volumes: counts",
        [&](PassBuilder& pass) {
            pass.color(counts, Load::clear);
            pass.depth_read_only(receivers);
            inputs.declare(pass);
            pass.vertices(input.handles.positions);
            pass.indices(buffers.indices);
            pass.indirect(buffers.draws);
        },
        [inputs, pipelines, draws = buffers.draws, indices = buffers.indices,
         far_caps = gn_volumes_has_far_cap(buffers.frame), positions = input.handles.positions](Recorder& r) {
            const auto at = [](std::uint32_t word) { return word * sizeof(std::uint32_t); };
            r.bind(pipelines->sides);
            inputs.set(r);
            r.draw_indirect(draws, at(sides_draw));
            r.vertex_buffer(positions);
            r.index_buffer(indices);
            for (std::uint32_t turned = 0; turned < 2; ++turned) {
                r.bind(pipelines->near[turned]);
                r.draw_indexed_indirect(draws, at(opaque_draw + 5 * turned));
                if (far_caps) {
                    r.bind(pipelines->far[turned]);
                    r.draw_indexed_indirect(draws, at(opaque_draw + 5 * turned));
                }
                r.bind(pipelines->masked[turned]);
                r.draw_indirect(draws, at(masked_draw + 4 * turned));
            }
        });
    return counts;
}

Visibility add_count_resolve(const FrameInput& input, TextureHandle counts) {
    const ViewSamples& samples = input.samples;
    const TextureHandle image = input.graph.create(TextureDesc{
        .name = "visibility", .format = VK_FORMAT_R32_SFLOAT, .width = samples.width, .height = samples.height});
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, samples);
    inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2D", "counts", counts);
    inputs.constant("GnLight", "light", input.whole_light().shape);
    const auto shader = made_once(input.prepared, "volume resolve", hashed(inputs).finish().low, [&] {
        const std::string text = "#include \"shadow/scene/light.h\"\n" + inputs.text() + resolve_text;
        return sealed(fullscreen({ShaderKind::fragment, "volume-resolve.frag", text}));
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
