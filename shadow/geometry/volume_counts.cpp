// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02] The raster pass of a light that counts.
// Based on: Hornus, Hoberock, Lefebvre, Hart. ZP+: Correct Z-pass Stencil Shadows. I3D 2005. [HHLH05]
// Departs from them: the count is a sum of blended floats, exact to 16 million, where eight bits of stencil wrap at 256; which
// side of the samples is counted each component of the mesh decides for itself.
#include "shadow/geometry/volume_passes.h"
#include "shadow/geometry/volumes.glsl"
#include "shadow/recipe/prepared.h"

namespace gn {

namespace {

// The vertex shaders clip at the near plane themselves, as volume_side.glsl does.
// An opaque cap's vertex, as it is, at the far end or on the near plane.
constexpr const char* opaque_text = R"(
layout(constant_id = 2) const int FAR = 0;
layout(location = 0) in vec3 in_position_ws;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    vec4 corner_ws = FAR != 0 ? gn_volumes_extrude(in_position_ws, u.frame.light_ws, u.frame.reach)
                              : vec4(in_position_ws, 1.0);
    gl_Position = gn_view_position(u.frame.cs_from_ws, corner_ws);
    gl_ClipDistance[0] = gn_volumes_beyond_near(gl_Position);
}
)";

constexpr const char* opaque_near_text = R"(
layout(location = 0) in vec3 in_position_ws;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    vec4 corner_cs = gn_view_position(u.frame.cs_from_ws, vec4(in_position_ws, 1.0));
    vec4 light_cs = gn_view_position(u.frame.cs_from_ws, u.frame.light_ws);
    gl_Position = gn_volumes_on_near(corner_cs, light_cs);
    gl_ClipDistance[0] = gn_volumes_before_near(corner_cs, light_cs);
}
)";

// A compared cap's vertex: of the near cap and of the far one, or on the near plane.
constexpr const char* compared_text = R"(
layout(constant_id = 3) const int BEFORE = 0;
layout(constant_id = 4) const int ON_NEAR = 0;
layout(location = 0) flat out int turned;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    uint corners = gn_volumes_has_far_cap(u.frame) ? 6u : 3u;
    uint slot = uint(gl_VertexIndex) / corners;
    uint corner = uint(gl_VertexIndex) % corners;
    uint cap = caps[BEFORE != 0 ? u.frame.triangles - 1u - slot : u.frame.opaque_triangles + slot];
    uint t = cap >> 1;
    turned = int(cap & 1u);
    // The near cap keeps the order of the triangle's corners, the far cap is its mirror image at infinity.
    bool far = corner >= 3u;
    vec3 p_ws = positions[indices[3u * t + (far ? (6u - corner) % 3u : corner)]];
    vec4 corner_ws = far ? gn_volumes_extrude(p_ws, u.frame.light_ws, u.frame.reach) : vec4(p_ws, 1.0);
    vec4 corner_cs = gn_view_position(u.frame.cs_from_ws, corner_ws);
    if (ON_NEAR != 0) {
        vec4 light_cs = gn_view_position(u.frame.cs_from_ws, u.frame.light_ws);
        gl_Position = gn_volumes_on_near(corner_cs, light_cs);
        gl_ClipDistance[0] = far ? -1.0 : gn_volumes_before_near(corner_cs, light_cs);
        return;
    }
    gl_Position = corner_cs;
    gl_ClipDistance[0] = gn_volumes_beyond_near(gl_Position);
    // A triangle with one side lies before a sample only where it shows its back, which nobody sees: elsewhere it counts as
    // every opaque cap does.
    if ((owners[t] & 6u) == 2u &&
        gn_volumes_side(positions[indices[3u * t]], positions[indices[3u * t + 1u]], positions[indices[3u * t + 2u]],
                        u.frame.eye_ws) > 0) {
        gl_Position.z = 0.0;
    }
}
)";

// Behind the sample a ray leaves volumes (+1) and enters them (-1); before it, it enters (+1) and leaves (-1). The far end is a
// mirror image.
constexpr const char* count_text = R"(
layout(constant_id = 1) const int TURNED = 0;
layout(constant_id = 2) const int FAR = 0;
layout(constant_id = 3) const int BEFORE = 0;
layout(location = 0) out float count;
void main() {
    count = (gl_FrontFacing == (TURNED == FAR)) == (BEFORE != 0) ? 1.0 : -1.0;
}
)";

constexpr const char* compared_count_text = R"(
layout(constant_id = 3) const int BEFORE = 0;
layout(location = 0) flat in int turned;
layout(location = 0) out float count;
void main() {
    count = (gl_FrontFacing == (turned == 0)) == (BEFORE != 0) ? 1.0 : -1.0;
}
)";

// What lies between a point of the near plane and the light begins with one volume more.
constexpr const char* near_count_text = R"(
layout(location = 0) out float count;
void main() { count = 1.0; }
)";

enum Way : std::uint32_t { turned_constant = 1, far_constant = 2, before_constant = 3, on_near_constant = 4 };

/// A pipeline that adds to the count. Behind: what lies at or behind the sample; depth is reversed, so that this is
/// LESS_OR_EQUAL, and before it is all else (volumes.md derives both).
struct CountShader {
    std::string_view name;
    std::string_view body;
    const char* count;
    VkCompareOp compare;
    SpecConstants constants;
    bool indexed = false;
};

RasterDesc count_pipeline(const ShaderInputs& inputs, const CountShader& shader) {
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, std::string(shader.name), volume_shader(inputs, shader.body)};
    desc.fragment = ShaderSource{ShaderKind::fragment, "volume-count.frag", shader.count};
    desc.constants = shader.constants;
    desc.blend = Blend::add;
    desc.depth_test = desc.depth_clamp = true;
    desc.depth_compare = shader.compare;
    if (shader.indexed) {
        desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
        desc.vertex_stride = sizeof(vec3);
    }
    return sealed(std::move(desc));
}

/// What counts: sides and compared caps, behind the sample and before it; opaque caps, by whether they are turned over; and what
/// closes volumes at the near plane.
struct CountPipelines {
    std::array<RasterDesc, 2> sides, compared, near, far;
    RasterDesc opaque_on_near, compared_on_near;
};

CountPipelines count_pipelines(const ShaderInputs& inputs, bool capped) {
    CountPipelines made;
    for (std::uint32_t i = 0; i < 2; ++i) {
        const VkCompareOp compare = i == 0 ? VK_COMPARE_OP_LESS_OR_EQUAL : VK_COMPARE_OP_GREATER;
        made.sides[i] =
            count_pipeline(inputs, {"volume-side.vert", side_body, count_text, compare, {{before_constant, i}}});
        made.compared[i] = count_pipeline(
            inputs, {"volume-compared.vert", compared_text, compared_count_text, compare, {{before_constant, i}}});
        // Opaque caps always count.
        const auto opaque = [&](std::uint32_t far) {
            return count_pipeline(inputs, {"volume-cap.vert",
                                           opaque_text,
                                           count_text,
                                           VK_COMPARE_OP_ALWAYS,
                                           {{turned_constant, i}, {far_constant, far}},
                                           true});
        };
        made.near[i] = opaque(0);
        made.far[i] = opaque(1);
    }
    if (capped) {
        made.opaque_on_near = count_pipeline(
            inputs, {"volume-cap-near.vert", opaque_near_text, near_count_text, VK_COMPARE_OP_ALWAYS, {}, true});
        made.compared_on_near = count_pipeline(inputs, {"volume-compared.vert",
                                                        compared_text,
                                                        near_count_text,
                                                        VK_COMPARE_OP_ALWAYS,
                                                        {{before_constant, 1}, {on_near_constant, 1}}});
    }
    return made;
}

VkDeviceSize at(std::uint32_t word) {
    return word * sizeof(std::uint32_t);
}

void draw_near_ends(Recorder& r, const CountPipelines& pipelines, BufferHandle draws) {
    r.bind(pipelines.opaque_on_near);
    r.draw_indexed_indirect(draws, at(opaque_draw));
    r.draw_indexed_indirect(draws, at(opaque_draw + 5));
    r.bind(pipelines.compared_on_near);
    r.draw_indirect(draws, at(compared_draw + 4));
}

void draw_opaque_caps(Recorder& r, const CountPipelines& pipelines, BufferHandle draws, bool far_caps) {
    for (std::uint32_t turned = 0; turned < 2; ++turned) {
        r.bind(pipelines.near[turned]);
        r.draw_indexed_indirect(draws, at(opaque_draw + 5 * turned));
        if (far_caps) {
            r.bind(pipelines.far[turned]);
            r.draw_indexed_indirect(draws, at(opaque_draw + 5 * turned));
        }
    }
}

}  // namespace

TextureHandle add_counts(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers) {
    const TextureHandle counts = input.graph.create(TextureDesc{.name = "volume counts",
                                                                .format = VK_FORMAT_R32_SFLOAT,
                                                                .width = input.samples.width,
                                                                .height = input.samples.height});
    ShaderInputs inputs = volume_side_inputs(input, buffers);
    inputs.buffer("readonly buffer", "Indices", "uint indices[];", input.handles.indices)
        .buffer("readonly buffer", "Caps", "uint caps[];", buffers.caps)
        .buffer("readonly buffer", "Owners", "uint owners[];", buffers.owners);
    const bool capped = buffers.frame.capped != 0;
    const auto pipelines = made_once(input.prepared, "volume counts", hashed(inputs).value(capped).finish().low,
                                     [&] { return count_pipelines(inputs, capped); });
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
        [inputs, pipelines, capped, draws = buffers.draws, indices = buffers.indices,
         far_caps = gn_volumes_has_far_cap(buffers.frame), positions = input.handles.positions](Recorder& r) {
            r.bind(pipelines->sides[0]);
            inputs.set(r);
            r.vertex_buffer(positions);
            r.index_buffer(indices);
            for (std::uint32_t before = 0; before < 2; ++before) {
                r.bind(pipelines->sides[before]);
                r.draw_indirect(draws, at(sides_draw + 4 * before));
                r.bind(pipelines->compared[before]);
                r.draw_indirect(draws, at(compared_draw + 4 * before));
            }
            if (capped) {
                draw_near_ends(r, *pipelines, draws);
            } else {
                draw_opaque_caps(r, *pipelines, draws, far_caps);
            }
        });
    return counts;
}

}  // namespace gn
