// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02] The raster passes of a light: counting, and what the count says.
// Departs from it: the count is a sum of blended floats, exact to 16 million, where eight bits of stencil wrap at 256.
#include "shadow/direct/volumes/volumes_passes.h"
#include "shadow/receiver/sample_pass.h"

namespace gn {

namespace {

// Both vertex shaders clip at the near plane themselves: depth clamping, which keeps what lies beyond the far plane,
// turns the fixed clipping off.
constexpr const char* side_text = R"(
#include "shadow/direct/volumes/volumes.glsl"
#include "shadow/view/project.glsl"
layout(constant_id = 0) const int STRIP = 0;
layout(binding = 0, scalar) uniform Frame { GnVolumesFrame frame; } u;
layout(binding = 1, scalar) readonly buffer Positions { vec3 positions[]; };
layout(binding = 2, scalar) readonly buffer Edges { uvec2 edges[]; };
layout(binding = 3, scalar) readonly buffer Sides { uint sides[]; };
layout(location = 0) flat out vec3 a_ws;
layout(location = 1) flat out vec3 b_ws;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    uint side = sides[uint(gl_VertexIndex) / 6u];
    uint corner = uint(gl_VertexIndex) % 6u;
    uvec2 edge = edges[side >> 1];
    a_ws = positions[edge.x];
    b_ws = positions[edge.y];
    // From outside the side is a, a at infinity, b at infinity, b; for the sun both points at infinity are one.
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
layout(binding = 4) uniform sampler2D depth;
void main() {
    gl_FragDepth = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r;
}
)";

constexpr const char* border_text = R"(
#include "shadow/direct/volumes/volumes.glsl"
layout(binding = 0, scalar) uniform Frame { GnVolumesFrame frame; } u;
layout(binding = 4) uniform sampler2D position_ws;
layout(binding = 5) uniform sampler2D normal_ws;
layout(location = 0) flat in vec3 a_ws;
layout(location = 1) flat in vec3 b_ws;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 p_ws = texelFetch(position_ws, pixel, 0);
    if (p_ws.w == 0.0 || !gn_volumes_touches(u.frame, p_ws.xyz, texelFetch(normal_ws, pixel, 0).xyz, a_ws, b_ws)) {
        discard;
    }
    gl_FragDepth = min(gl_FragCoord.z * 1.00001, 1.0);
}
)";

constexpr const char* cap_text = R"(
#include "shadow/direct/volumes/volumes.glsl"
#include "shadow/view/project.glsl"
layout(constant_id = 0) const int MASKED = 0;
layout(constant_id = 1) const int TURNED = 0;
layout(binding = 0, scalar) uniform Frame { GnVolumesFrame frame; } u;
layout(binding = 1, scalar) readonly buffer Positions { vec3 positions[]; };
layout(binding = 2, scalar) readonly buffer Indices { uint indices[]; };
layout(binding = 3, scalar) readonly buffer Caps { uint caps[]; };
layout(binding = 5, scalar) readonly buffer Owners { uint owners[]; };
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    uint corners = gn_volumes_has_far_cap(u.frame) ? 6u : 3u;
    uint slot = uint(gl_VertexIndex) / corners;
    uint corner = uint(gl_VertexIndex) % corners;
    uint first = MASKED != 0 ? u.frame.opaque_triangles : 0u;
    uint end = MASKED != 0 ? u.frame.triangles : u.frame.opaque_triangles;
    uint t = caps[TURNED != 0 ? end - 1u - slot : first + slot];
    // The near cap keeps the order of the triangle's corners, the far cap is its mirror image at infinity.
    bool far = corner >= 3u;
    vec3 p_ws = positions[indices[3u * t + (far ? (6u - corner) % 3u : corner)]];
    vec4 corner_ws = far ? gn_volumes_extrude(p_ws, u.frame.light_ws, u.frame.reach) : vec4(p_ws, 1.0);
    gl_Position = gn_view_position(u.frame.cs_from_ws, corner_ws);
    gl_ClipDistance[0] = gl_Position.w - gl_Position.z;
    // A triangle with one side lies before a sample only where it shows its back, which nobody sees: elsewhere it counts as
    // every opaque cap does.
    if (MASKED != 0 && (owners[t] & 6u) == 2u &&
        gn_volumes_side(positions[indices[3u * t]], positions[indices[3u * t + 1u]], positions[indices[3u * t + 2u]],
                        u.frame.eye_ws) > 0) {
        gl_Position.z = 0.0;
    }
}
)";

constexpr const char* count_text = R"(
layout(constant_id = 1) const int TURNED = 0;
layout(location = 0) out float count;
void main() {
    // What lies behind the sample: +1 where a ray leaves the volume, -1 where it enters.
    count = gl_FrontFacing == (TURNED == 0) ? -1.0 : 1.0;
}
)";

constexpr const char* resolve_text = R"(
#include "shadow/scene/light.h"
layout(binding = 0, scalar) uniform Light { GnLight light; } u;
layout(binding = 1) uniform sampler2D position_ws;
layout(binding = 2) uniform sampler2D normal_ws;
layout(binding = 3) uniform sampler2D counts;
layout(location = 0) out float visibility;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 p_ws = texelFetch(position_ws, pixel, 0);
    bool counted = p_ws.w > 0.0 && gn_counted(u.light, p_ws.xyz, texelFetch(normal_ws, pixel, 0).xyz);
    visibility = counted && texelFetch(counts, pixel, 0).r == 0.0 ? 1.0 : 0.0;
}
)";

// Z-fail: what lies at or behind the sample counts. Depth is reversed, so that this is LESS_OR_EQUAL; opaque caps always
// count (volumes.md derives both).
RasterDesc volume_pipeline(const char* name, const char* text, VkCompareOp compare, bool turned) {
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, name, text};
    desc.fragment = ShaderSource{ShaderKind::fragment, "volume-count.frag", count_text};
    desc.constants = {{1, turned ? 1U : 0U}};
    desc.blend = Blend::add;
    desc.depth_test = desc.depth_clamp = true;
    desc.depth_compare = compare;
    return desc;
}

RasterDesc receiver_pipeline() {
    RasterDesc desc = fullscreen({ShaderKind::fragment, "volume-receiver.frag", receiver_text});
    desc.depth_test = desc.depth_write = true;
    desc.depth_compare = VK_COMPARE_OP_ALWAYS;
    return desc;
}

// The beginning of each side, where it may lie before a sample that touches the edge it hangs from.
RasterDesc border_pipeline() {
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, "volume-side.vert", side_text};
    desc.fragment = ShaderSource{ShaderKind::fragment, "volume-border.frag", border_text};
    desc.constants = {{0, 1U}};
    desc.depth_test = desc.depth_write = desc.depth_clamp = true;
    desc.depth_compare = VK_COMPARE_OP_GREATER;
    return desc;
}

RasterDesc cap_pipeline(bool masked, bool turned) {
    RasterDesc desc = volume_pipeline("volume-cap.vert", cap_text,
                                      masked ? VK_COMPARE_OP_LESS_OR_EQUAL : VK_COMPARE_OP_ALWAYS, turned);
    desc.constants = {{0, masked ? 1U : 0U}, {1, turned ? 1U : 0U}};
    return desc;
}

}  // namespace

namespace {

// The shaders' common inputs; names that a shader does not use are ignored.
void set_inputs(Recorder& r, const VolumeBuffers& buffers, const SceneHandles& handles) {
    r.set_value("u", buffers.frame);
    r.set("Positions", handles.positions);
    r.set("Indices", handles.indices);
    r.set("Edges", buffers.edges);
    r.set("Sides", buffers.sides);
    r.set("Caps", buffers.caps);
    r.set("Owners", buffers.owners);
}

}  // namespace

TextureHandle add_receivers(const FrameInput& input, const VolumeBuffers& buffers) {
    const ViewSamples& samples = input.samples;
    const TextureHandle lifted = input.graph.create(TextureDesc{
        .name = "volume receivers", .format = VK_FORMAT_D32_SFLOAT, .width = samples.width, .height = samples.height});
    input.graph.add_pass(
        "volumes: receivers",
        [&](PassBuilder& pass) {
            pass.depth(lifted, Load::clear);
            pass.sample(lent(samples.depth, "depth"));
            pass.sample(samples.position);
            pass.sample(samples.normal);
            for (const BufferHandle read : {input.handles.positions, buffers.edges, buffers.sides}) {
                pass.storage_read(read);
            }
            pass.indirect(buffers.draws);
        },
        [samples, buffers, handles = input.handles](Recorder& r) {
            // Take the view samples' depth bit for bit, then lift what touches an edge before the side that hangs there.
            r.bind(receiver_pipeline());
            r.set("depth", samples.depth);
            r.draw(3);
            r.bind(border_pipeline());
            set_inputs(r, buffers, handles);
            r.set("position_ws", samples.position);
            r.set("normal_ws", samples.normal);
            r.draw_indirect(buffers.draws, 0);
        });
    return lifted;
}

TextureHandle add_counts(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers) {
    const TextureHandle counts = input.graph.create(TextureDesc{.name = "volume counts",
                                                                .format = VK_FORMAT_R32_SFLOAT,
                                                                .width = input.samples.width,
                                                                .height = input.samples.height});
    input.graph.add_pass(
        "volumes: counts",
        [&](PassBuilder& pass) {
            pass.color(counts, Load::clear);
            pass.depth_read_only(receivers);
            for (const BufferHandle read : {input.handles.positions, input.handles.indices, buffers.edges,
                                            buffers.sides, buffers.caps, buffers.owners}) {
                pass.storage_read(read);
            }
            pass.indirect(buffers.draws);
        },
        [buffers, handles = input.handles](Recorder& r) {
            r.bind(volume_pipeline("volume-side.vert", side_text, VK_COMPARE_OP_LESS_OR_EQUAL, false));
            set_inputs(r, buffers, handles);
            r.draw_indirect(buffers.draws, 0);
            for (const unsigned list : {0U, 1U, 2U, 3U}) {
                r.bind(cap_pipeline(list >= 2, list % 2 == 1));
                set_inputs(r, buffers, handles);
                r.draw_indirect(buffers.draws, (list + 1) * sizeof(VkDrawIndirectCommand));
            }
        });
    return counts;
}

Visibility add_count_resolve(const FrameInput& input, TextureHandle counts) {
    const ViewSamples& samples = input.samples;
    const TextureHandle image = input.graph.create(TextureDesc{
        .name = "visibility", .format = VK_FORMAT_R32_SFLOAT, .width = samples.width, .height = samples.height});
    input.graph.add_pass(
        "volumes: resolve",
        [&](PassBuilder& pass) {
            pass.color(image, Load::clear);
            pass.sample(counts);
            pass.sample(samples.position);
            pass.sample(samples.normal);
        },
        [samples, counts, light = input.whole_light().shape](Recorder& r) {
            r.bind(fullscreen({ShaderKind::fragment, "volume-resolve.frag", resolve_text}));
            r.set("counts", counts);
            r.set_value("u", light);
            r.set("position_ws", samples.position);
            r.set("normal_ws", samples.normal);
            r.draw(3);
        });
    return {image};
}

}  // namespace gn
