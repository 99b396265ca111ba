// SPDX-License-Identifier: MIT
// Based on: Blinn. Me and My (Fake) Shadow. IEEE Computer Graphics and Applications 1988. [Bli88]
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, section 7.1. 2018. [AHH18]
#include "shadow/geometry/flattened.h"

#include "shadow/geometry/draw.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>

namespace gn {
namespace {

constexpr const char* receiver_text = R"(
layout(constant_id = 0) const int MARK = 0;
layout(location = 0) out float visibility;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 p_ws = gbuffer_position_texel(pixel);
    vec3 n_ws = gbuffer_normal_texel(pixel).xyz;
    bool counted = p_ws.w > 0.0 && gn_counted(u.light, p_ws.xyz, n_ws);
    if (MARK != 0 && !(counted && gn_on_plane(u.frame.plane_ws, u.frame.tolerance, p_ws.xyz, n_ws))) {
        discard;
    }
    visibility = counted ? 1.0 : 0.0;
}
)";

constexpr const char* caster_vertex_text = R"(
layout(location = 0) out vec3 out_mask;  // uv, and the alpha of the vertices
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[2]; };
void main() {
    vec3 p_ws = positions[gl_VertexIndex];
    out_mask = vec3(uvs[gl_VertexIndex], colors[min(gl_VertexIndex, colors.length() - 1)].a);
    gl_Position = u.frame.cs_from_ws * gn_plane_project(u.frame.plane_ws, u.frame.light_ws, p_ws);
    // Only what stands between plane and light casts: the rest would throw an antishadow. [AHH18] section 7.1
    float height = gn_plane_height(u.frame.plane_ws, vec4(p_ws, 1.0));
    gl_ClipDistance[0] = height - u.frame.tolerance;
    gl_ClipDistance[1] = u.frame.light_ws.w > 0.0 ? gn_plane_height(u.frame.plane_ws, u.frame.light_ws) - height : 1.0;
}
)";

constexpr const char* caster_begin_text = R"(
layout(constant_id = 0) const int MASKED = 0;
layout(push_constant, scalar) uniform Push { float base_alpha; float cutoff; } push;
layout(location = 0) in vec3 in_mask;
layout(location = 0) out float result;
void main() {
    float alpha = textureLod(base_color_texture, in_mask.xy, 0.0).a * push.base_alpha * in_mask.z;
    if (MASKED != 0 && alpha < push.cutoff) {
        discard;
    }
)";

RasterDesc with_stencil(RasterDesc desc, VkCompareOp compare, VkStencilOp pass) {
    const VkStencilOpState state{.failOp = VK_STENCIL_OP_KEEP,
                                 .passOp = pass,
                                 .depthFailOp = pass,
                                 .compareOp = compare,
                                 .compareMask = 0xFF,
                                 .writeMask = 0xFF,
                                 .reference = 0};
    desc.stencil = StencilOps{state, state};
    return desc;
}

std::string head(const ShaderInputs& inputs, std::string_view includes = "") {
    return include_line("shadow/geometry/flattened.glsl") + include_line("shadow/scene/light.h") +
           std::string(includes) + inputs.text();
}

void draw_casters(Recorder& r, const Scene& scene, const SceneHandles& handles, const std::vector<CasterKind>& kinds,
                  bool masked) {
    if (!masked) {
        for (const TriangleRun& run : opaque_caster_runs(scene, kinds)) {
            r.draw_indexed(run.count * 3, 1, run.first * 3);
        }
        return;
    }
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        if (kinds[i] == CasterKind::masked) {
            const Object& object = scene.objects[i];
            const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
            const BaseColor color = base_color(scene, handles, material);
            r.set("base_color_texture", color.texture, color.sampler);
            r.push_value(alpha_test(material));
            r.draw_indexed(object.triangle_count * 3, 1, object.first_triangle * 3);
        }
    }
}

}  // namespace

LitPlanes lit_planes(const mat4& cs_from_ws, const ReceiverPlanes& found, vec4 light_ws) {
    LitPlanes lit;
    for (std::size_t i = 0; i < found.planes.size(); ++i) {
        const vec4 plane_ws = found.planes[i].plane_ws;
        const float height = glm::dot(plane_ws, light_ws);
        if (height != 0.0F) {
            lit.planes.push_back({cs_from_ws, light_ws, height > 0.0F ? plane_ws : -plane_ws, found.tolerance});
            lit.number.push_back(static_cast<std::uint32_t>(i));
        }
    }
    return lit;
}

// No depth test: the stencil knows the plane of each sample, so nothing can fight over it.
// The viewer is on the light's side of a plane that it sees lit, so that a projected triangle turns as the light sees it.
FlatCasters::FlatCasters(const FrameInput& input, const FlatDraw& draw)
    : scene_(&input.scene), handles_(input.handles), sides_(split_sides(input.scene, caster_kinds(input))) {
    declared_ = inputs({}, draw.extra);
    for (unsigned way = 0; way < 4; ++way) {
        const std::uint64_t key = hashed(declared_)
                                      .value(way)
                                      .value(draw.stencil)
                                      .value(draw.blend)
                                      .text(draw.includes)
                                      .text(draw.fragment)
                                      .finish()
                                      .low;
        pipelines_[way] = made_once(input.prepared, "flat casters", key, [&] {
            RasterDesc desc;
            desc.cull = (way & 2U) != 0 ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
            desc.blend = draw.blend;
            desc.vertex = {ShaderKind::vertex, "flat-caster.vert", head(declared_, draw.includes) + caster_vertex_text};
            desc.fragment =
                ShaderSource{ShaderKind::fragment, "flat-caster.frag",
                             head(declared_, draw.includes) + caster_begin_text + std::string(draw.fragment) + "}\n"};
            desc.constants = {{0, way & 1U}};
            return sealed(draw.stencil ? with_stencil(desc, VK_COMPARE_OP_EQUAL, VK_STENCIL_OP_ZERO) : desc);
        });
    }
}

ShaderInputs FlatCasters::inputs(const GnFlattening& frame, const ShaderInputs& extra) const {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", handles_.positions);
    inputs.buffer("readonly buffer", "Uvs", "vec2 uvs[];", handles_.uvs);
    inputs.buffer("readonly buffer", "Colors", "vec4 colors[];", handles_.colors);
    inputs.texture("sampler2D", "base_color_texture", handles_.white);
    inputs.constant("GnFlattening", "frame", frame);
    inputs.add(extra);
    return inputs;
}

void FlatCasters::declare(PassBuilder& pass) const {
    pass.indices(handles_.indices);
    declared_.declare(pass);
    sample_textures(pass, handles_);
}

void FlatCasters::record(Recorder& r, const ShaderInputs& inputs, std::uint32_t stencil_reference) const {
    for (const unsigned way : {0U, 1U, 2U, 3U}) {
        const bool masked = (way & 1U) != 0;
        const std::vector<CasterKind>& kinds = (way & 2U) != 0 ? sides_.one : sides_.both;
        if (std::find(kinds.begin(), kinds.end(), masked ? CasterKind::masked : CasterKind::opaque) == kinds.end()) {
            continue;
        }
        r.bind(*pipelines_[way]);
        r.stencil_reference(stencil_reference);
        r.index_buffer(handles_.indices);
        inputs.set(r);
        r.push_value(AlphaTest{});
        draw_casters(r, *scene_, handles_, kinds, masked);
    }
}

std::shared_ptr<const RasterDesc> flat_receiver_pipeline(const FrameInput& input, const ShaderInputs& inputs,
                                                         bool mark) {
    return made_once(input.prepared, "flat receivers", hashed(inputs).value(mark).finish().low, [&] {
        RasterDesc desc = fullscreen({ShaderKind::fragment, "flat-receiver.frag", head(inputs) + receiver_text});
        desc.constants = {{0, mark ? 1U : 0U}};
        desc.color_mask = mark ? 0 : 0xF;
        return sealed(with_stencil(desc, VK_COMPARE_OP_ALWAYS, mark ? VK_STENCIL_OP_REPLACE : VK_STENCIL_OP_ZERO));
    });
}

ShaderInputs flat_receiver_inputs(const FrameInput& input, const GnFlattening& frame) {
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.constant("GnLight", "light", input.whole_light().shape).constant("GnFlattening", "frame", frame);
    return inputs;
}

}  // namespace gn
