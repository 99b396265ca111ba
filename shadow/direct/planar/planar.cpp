// SPDX-License-Identifier: MIT
// Based on: Blinn. Me and My (Fake) Shadow. IEEE Computer Graphics and Applications 1988. [Bli88]
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, section 7.1. 2018. [AHH18]
// Departs from it: receiver planes are found in the mesh, and the stencil names the plane of each view sample.
//
// Also here: planar_planes.h, planar_planes.cpp.
#include "shadow/direct/planar/planar.h"

#include "gpu/hash.h"
#include "shadow/direct/planar/planar_planes.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/draw.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>
#include <array>

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
    if (MARK != 0 && !(counted && gn_planar_on_plane(u.frame.plane_ws, u.frame.tolerance, p_ws.xyz, n_ws))) {
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
    gl_Position = u.frame.cs_from_ws * gn_planar_project(u.frame.plane_ws, u.frame.light_ws, p_ws);
    // Only what stands between plane and light casts: the rest would throw an antishadow. [AHH18] section 7.1
    float height = gn_planar_height(u.frame.plane_ws, vec4(p_ws, 1.0));
    gl_ClipDistance[0] = height - u.frame.tolerance;
    gl_ClipDistance[1] = u.frame.light_ws.w > 0.0 ? gn_planar_height(u.frame.plane_ws, u.frame.light_ws) - height : 1.0;
}
)";

constexpr const char* caster_fragment_text = R"(
layout(constant_id = 0) const int MASKED = 0;
layout(push_constant, scalar) uniform Push { float base_alpha; float cutoff; } push;
layout(location = 0) in vec3 in_mask;
layout(location = 0) out float visibility;
void main() {
    float alpha = textureLod(base_color_texture, in_mask.xy, 0.0).a * push.base_alpha * in_mask.z;
    if (MASKED != 0 && alpha < push.cutoff) {
        discard;
    }
    visibility = 0.0;
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

std::string head(const ShaderInputs& inputs) {
    return include_line("shadow/direct/planar/planar.glsl") + include_line("shadow/scene/light.h") + inputs.text();
}

/// Light every sample that counts (false), or write a plane's number where it is seen (true).
std::array<std::shared_ptr<const RasterDesc>, 2> receiver_pipelines(const FrameInput& input,
                                                                    const ShaderInputs& inputs) {
    const auto pipeline = [&](bool mark) {
        return made_once(input.prepared, "planar receivers", hashed(inputs).value(mark).finish().low, [&] {
            RasterDesc desc = fullscreen({ShaderKind::fragment, "planar-receiver.frag", head(inputs) + receiver_text});
            desc.constants = {{0, mark ? 1U : 0U}};
            desc.color_mask = mark ? 0 : 0xF;
            return sealed(with_stencil(desc, VK_COMPARE_OP_ALWAYS, mark ? VK_STENCIL_OP_REPLACE : VK_STENCIL_OP_ZERO));
        });
    };
    return {pipeline(false), pipeline(true)};
}

/// By way: + 1 where alpha is tested, + 2 where only fronts cast.
// No depth test: the stencil knows the plane of each sample, so nothing can fight over it.
// The viewer is on the light's side of a plane that it sees lit, so that a projected triangle turns as the light sees it.
std::array<std::shared_ptr<const RasterDesc>, 4> caster_pipelines(const FrameInput& input, const ShaderInputs& inputs) {
    const auto pipeline = [&](unsigned way) {
        return made_once(input.prepared, "planar casters", hashed(inputs).value(way).finish().low, [&] {
            RasterDesc desc;
            desc.cull = (way & 2U) != 0 ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
            desc.vertex = {ShaderKind::vertex, "planar-caster.vert", head(inputs) + caster_vertex_text};
            desc.fragment =
                ShaderSource{ShaderKind::fragment, "planar-caster.frag", head(inputs) + caster_fragment_text};
            desc.constants = {{0, way & 1U}};
            return sealed(with_stencil(desc, VK_COMPARE_OP_EQUAL, VK_STENCIL_OP_ZERO));
        });
    };
    return {pipeline(0), pipeline(1), pipeline(2), pipeline(3)};
}

// The planes that this light shines on, turned towards it.
std::vector<GnPlanarFrame> lit_planes(const FrameInput& input, const ReceiverPlanes& found) {
    std::vector<GnPlanarFrame> frames;
    const vec4 light_ws = light_point_ws(input.light().shape);
    for (const ReceiverPlane& receiver : found.planes) {
        const float height = glm::dot(receiver.plane_ws, light_ws);
        if (height != 0.0F) {
            frames.push_back({input.samples.constants.cs_from_ws, light_ws,
                              height > 0.0F ? receiver.plane_ws : -receiver.plane_ws, found.tolerance});
        }
    }
    return frames;
}

/// What the receivers' shader reads, of one plane.
ShaderInputs receiver_inputs(const FrameInput& input, const GnPlanarFrame& frame) {
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.constant("GnLight", "light", input.whole_light().shape).constant("GnPlanarFrame", "frame", frame);
    return inputs;
}

void add_receivers(const FrameInput& input, const std::vector<GnPlanarFrame>& planes, TextureHandle image) {
    // First all samples, then plane after plane.
    std::vector<ShaderInputs> inputs{receiver_inputs(input, {})};
    for (const GnPlanarFrame& frame : planes) {
        inputs.push_back(receiver_inputs(input, frame));
    }
    input.graph.add_pass(
        "planar: receivers",
        [&](PassBuilder& pass) {
            pass.color(image, Load::clear);
            pass.depth_read_only(lent(input.samples.depth, "depth"));
            inputs.front().declare(pass);
        },
        [inputs, pipelines = receiver_pipelines(input, inputs.front())](Recorder& r) {
            for (std::uint32_t i = 0; i < inputs.size(); ++i) {
                r.bind(*pipelines[i == 0 ? 0 : 1]);
                r.stencil_reference(i);
                inputs[i].set(r);
                r.draw(3);
            }
        });
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

/// What the casters' shaders read, above one plane; masked ones bring their own texture.
ShaderInputs caster_inputs(const SceneHandles& handles, const GnPlanarFrame& frame) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", handles.positions);
    inputs.buffer("readonly buffer", "Uvs", "vec2 uvs[];", handles.uvs);
    inputs.buffer("readonly buffer", "Colors", "vec4 colors[];", handles.colors);
    inputs.texture("sampler2D", "base_color_texture", handles.white);
    inputs.constant("GnPlanarFrame", "frame", frame);
    return inputs;
}

void add_casters(const FrameInput& input, const std::vector<GnPlanarFrame>& planes, TextureHandle image) {
    const CasterSides sides = split_sides(input.scene, caster_kinds(input));
    std::vector<ShaderInputs> inputs;
    for (const GnPlanarFrame& frame : planes) {
        inputs.push_back(caster_inputs(input.handles, frame));
    }
    const ShaderInputs declared = caster_inputs(input.handles, {});
    input.graph.add_pass(
        "planar: casters",
        [&](PassBuilder& pass) {
            pass.color(image, Load::keep);
            pass.depth_read_only(lent(input.samples.depth, "depth"));
            pass.indices(input.handles.indices);
            declared.declare(pass);
            sample_textures(pass, input.handles);
        },
        [handles = input.handles, scene = &input.scene, inputs, sides,
         pipelines = caster_pipelines(input, declared)](Recorder& r) {
            // A shadowed sample loses its plane's number, so that no second caster darkens it again.
            const auto any = [](const std::vector<CasterKind>& kinds, CasterKind kind) {
                return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
            };
            for (std::uint32_t i = 0; i < inputs.size(); ++i) {
                for (const unsigned way : {0U, 1U, 2U, 3U}) {
                    const bool masked = (way & 1U) != 0;
                    const std::vector<CasterKind>& kinds = (way & 2U) != 0 ? sides.one : sides.both;
                    if (!any(kinds, masked ? CasterKind::masked : CasterKind::opaque)) {
                        continue;
                    }
                    r.bind(*pipelines[way]);
                    r.stencil_reference(i + 1);
                    r.index_buffer(handles.indices);
                    inputs[i].set(r);
                    r.push_value(AlphaTest{});
                    draw_casters(r, *scene, handles, kinds, masked);
                }
            }
        });
}

Visibility add_planar(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnPlanarParams>("planar");
    const std::uint64_t key = Hasher().value(params.min_area).value(params.tolerance).value(params.planes).finish().low;
    const auto found = input.derive("receiver planes", key, [&] { return receiver_planes(input.scene, params); });
    if (found->planes.empty()) {
        refuse(
            "planar needs a flat receiver of at least {:.3g} % of the scene's surface, and the largest in '{}' has "
            "{:.3g} "
            "%: lower planar.min_area or take volumes",
            100.0 * static_cast<double>(params.min_area), input.scene.name, 100.0 * found->largest);
    }
    const std::vector<GnPlanarFrame> planes = lit_planes(input, *found);
    const TextureHandle image = input.graph.create(TextureDesc{.name = "visibility",
                                                               .format = VK_FORMAT_R32_SFLOAT,
                                                               .width = input.samples.width,
                                                               .height = input.samples.height});
    add_receivers(input, planes, image);
    add_casters(input, planes, image);
    return {image};
}

}  // namespace

namespace parts {

const Part& direct_planar() {
    static const Part part = [] {
        Part p;
        p.id = "planar";
        p.stage = Stage::direct;
        p.title = "Planar shadows";
        p.citation = "Bli88";
        p.features = {Feature::depth32_stencil8};
        p.needs_scene = true;
        p.params = param_table<GnPlanarParams>({
            GN_PARAM(GnPlanarParams, planes, integer, 1, 64, "",
                     "More flat receivers get shadows, each for one more drawing of all casters."),
            GN_PARAM(GnPlanarParams, min_area, real, 0, 1, "of the scene's surface",
                     "Smaller flat parts stay without shadow."),
            GN_PARAM(GnPlanarParams, tolerance, real, 1e-7, 1e-2, "of the scene's diagonal",
                     "Rougher planes receive; what stands lower than this above one casts nothing."),
        });
        p.params_type = "GnPlanarParams";
        p.glsl = "shadow/direct/planar/planar.glsl";
        p.add_direct = add_planar;
        return p;
    }();
    return part;
}

}  // namespace parts
}  // namespace gn
