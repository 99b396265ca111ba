// SPDX-License-Identifier: MIT
// The view samples: one G-buffer of what each pixel of the view sees.
//
// How exact are the positions? The interpolated position is moved along the triangle's exact normal into the triangle's
// plane (the vertices are the very floats that the truth traces), so what remains is the rounding of the coordinates: half a
// unit in the last place each (view_test.cpp holds it to that).
#include "gpu/vk_names.h"
#include "shadow/frame/frame.h"
#include "shadow/geometry/draw.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/scene/casting.h"

namespace gn {
namespace {

constexpr const char* vertex_text = R"(
#include "shadow/view/project.glsl"
layout(location = 0) in vec3 in_position_ws;
layout(location = 0) out vec3 out_position_ws;
layout(location = 1) out vec3 out_normal_ws;
layout(location = 2) out vec2 out_uv;
layout(location = 3) flat out vec3 out_corner_ws;
#ifdef GN_COLORED
layout(location = 4) out vec4 out_color;
#endif
invariant gl_Position;
void main() {
    gl_Position = gn_view_position(u.view.cs_from_ws, vec4(in_position_ws, 1.0));
    out_position_ws = out_corner_ws = in_position_ws;
    out_normal_ws = normals[gl_VertexIndex];
    out_uv = uvs[gl_VertexIndex];
#ifdef GN_COLORED
    out_color = colors[gl_VertexIndex];
#endif
}
)";

struct GBufferPush {
    vec4 base_color;
    float roughness, metallic, alpha_cutoff;
    std::uint32_t first_triangle, object;
    float surface;
};

/// Faces that are drawn together. Of two faces in one plane, back to back, rounding decides which is nearer, and the one
/// turned to the viewer must show: so all fronts are drawn first, then backs a little farther away than they are. Their
/// true depth is written last, where no front came to lie before them.
struct Faces {
    VkCullModeFlags culled;
    bool pushed, depth_only;
};
constexpr std::array rounds{Faces{VK_CULL_MODE_BACK_BIT, false, false}, Faces{VK_CULL_MODE_FRONT_BIT, true, false},
                            Faces{VK_CULL_MODE_FRONT_BIT, false, true}};

// By how much backs are pushed. Vertices are rounded to the rasterizer's grid of 1/256 pixel, in both faces alike where they
// share corners, by different planes where they do not: four such steps. Interpolation errs by units of the depth's last
// place at the nearest corner: four of them.
constexpr float push_units = 4;
constexpr float push_pixels = 4.0F / 256;

/// What is left out where it is not there: most materials are neither tested for alpha, which keeps hidden fragments from
/// being left out, nor have a texture, and most scenes no colours by vertex.
struct Variant {
    bool masked, textured, colored;
};

/// What both stages read. The texture is set anew by every draw that reads one.
ShaderInputs gbuffer_inputs(const GnViewConstants& view, const SceneHandles& handles) {
    ShaderInputs inputs;
    inputs.constant("GnViewConstants", "view", view)
        .buffer("readonly buffer", "Normals", "vec3 normals[];", handles.normals)
        .buffer("readonly buffer", "Uvs", "vec2 uvs[];", handles.uvs)
        .buffer("readonly buffer", "Colors", "vec4 colors[];", handles.colors)
        .buffer("readonly buffer", "FaceNormals", "vec3 face_normals[];", handles.face_normals)
        .texture("sampler2D", "base_color_texture", handles.white);
    return inputs;
}

RasterDesc gbuffer_pipeline(const Faces& faces, const Variant& variant) {
    RasterDesc desc;
    desc.cull = faces.culled;
    desc.depth_bias = faces.pushed;
    desc.color_mask = faces.depth_only ? 0 : 0xF;
    const std::string head = (variant.colored ? "#define GN_COLORED\n" : "") + include_line("shadow/view/view.glsl") +
                             include_line("shadow/view/surface.glsl") + gbuffer_inputs({}, {}).text();
    desc.vertex = {ShaderKind::vertex, "gbuffer.vert", head + vertex_text};
    if (variant.masked || !faces.depth_only) {
        desc.fragment = ShaderSource{ShaderKind::fragment, "gbuffer.frag",
                                     std::string(variant.masked ? "#define GN_MASKED\n" : "") +
                                         (variant.textured ? "#define GN_TEXTURED\n" : "") + head +
                                         include_line("shadow/view/gbuffer.glsl")};
    }
    desc.depth_test = desc.depth_write = true;
    desc.depth_compare = VK_COMPARE_OP_GREATER;
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
    desc.vertex_stride = sizeof(vec3);
    return sealed(desc);
}

/// By round and variant.
const RasterDesc& pipeline(std::size_t round, const Variant& variant) {
    static const auto all = [] {
        std::array<std::array<RasterDesc, 8>, rounds.size()> made;
        for (std::size_t i = 0; i < rounds.size(); ++i) {
            for (std::size_t k = 0; k < 8; ++k) {
                made[i][k] = gbuffer_pipeline(rounds[i], {(k & 4) != 0, (k & 2) != 0, (k & 1) != 0});
            }
        }
        return made;
    }();
    return all[round][(variant.masked ? 4U : 0U) + (variant.textured ? 2U : 0U) + (variant.colored ? 1U : 0U)];
}

TextureHandle target(FrameGraph& graph, const char* name, VkFormat format, uint width, uint height) {
    return graph.create({.name = name, .format = format, .width = width, .height = height});
}

void draw_objects(Recorder& r, const Scene& scene, const SceneHandles& handles, std::size_t round) {
    // Depth is reversed: less is farther.
    r.depth_bias(-push_units, -push_pixels);
    const RasterDesc* bound = nullptr;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (rounds[round].culled == VK_CULL_MODE_FRONT_BIT && is_single_sided(scene, object)) {
            continue;
        }
        const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
        const bool masked = is_masked(scene, object);
        const bool textured = material.base_color_texture >= 0;
        const RasterDesc& wanted = pipeline(round, {masked, textured, !scene.colors.empty()});
        if (&wanted != bound) {
            r.bind(wanted);
            bound = &wanted;
        }
        if (masked || textured) {
            const BaseColor color = base_color(scene, handles, material);
            r.set("base_color_texture", color.texture, color.sampler);
        }
        r.push_value(GBufferPush{material.base_color, material.roughness, material.metallic,
                                 alpha_test(material).cutoff, object.first_triangle, static_cast<std::uint32_t>(i),
                                 object.receives ? 1.0F : 2.0F});
        r.draw_indexed(object.triangle_count * 3, 1, object.first_triangle * 3);
    }
}

}  // namespace

GnViewConstants view_constants(const Camera& camera, uint width, uint height) {
    const mat4 from_ws = vs_from_ws(camera);
    const mat4 rows = glm::transpose(from_ws);
    const double pixel = 2 * half_height_at(camera, 1) / height;
    return {.cs_from_ws = cs_from_vs(camera, static_cast<float>(width) / static_cast<float>(height)) * from_ws,
            .eye_ws = eye_of(camera),
            .axis_ws = -rows[2],
            .right_ws = vec4(pixel * dvec3(rows[0]), 0),
            .down_ws = vec4(-pixel * dvec3(rows[1]), 0),
            .size = uvec4(width, height, 0, 0)};
}

ViewSamples lent_samples(const FrameGraph& graph, const Camera& camera, TextureHandle position, TextureHandle normal) {
    const TextureDesc& size = graph.desc(position);
    for (const TextureHandle texture : {position, normal}) {
        const TextureDesc& desc = graph.desc(texture);
        if (desc.format != VK_FORMAT_R32G32B32A32_SFLOAT || desc.width != size.width || desc.height != size.height) {
            fail("lent texture '{}' of {} x {} in {}: positions and normals are rgba32f, both of {} x {}", desc.name,
                 desc.width, desc.height, format_name(desc.format), size.width, size.height);
        }
    }
    return {.width = size.width,
            .height = size.height,
            .camera = camera,
            .constants = view_constants(camera, size.width, size.height),
            .position = position,
            .normal = normal};
}

ViewSamples add_view_samples(FrameGraph& graph, const SceneGpu& scene, const SceneHandles& handles,
                             const Camera& camera, uint width, uint height) {
    ViewSamples samples{.width = width, .height = height, .camera = camera};
    samples.constants = view_constants(camera, width, height);
    samples.position = target(graph, "position", VK_FORMAT_R32G32B32A32_SFLOAT, width, height);
    samples.normal = target(graph, "normal", VK_FORMAT_R32G32B32A32_SFLOAT, width, height);
    samples.albedo = target(graph, "albedo", VK_FORMAT_R8G8B8A8_SRGB, width, height);
    samples.surface = target(graph, "surface", VK_FORMAT_R32G32_UINT, width, height);
    samples.depth = target(graph, "depth", VK_FORMAT_D32_SFLOAT_S8_UINT, width, height);

    const ShaderInputs inputs = gbuffer_inputs(samples.constants, handles);
    graph.add_pass(
        "view samples",
        [&](PassBuilder& pass) {
            for (const TextureHandle color : {samples.position, samples.normal, samples.albedo, samples.surface}) {
                pass.color(color, Load::clear);
            }
            pass.depth(samples.depth, Load::clear, {.depth = 0.0F});
            pass.vertices(handles.positions);
            pass.indices(handles.indices);
            inputs.declare(pass);
            sample_textures(pass, handles);
        },
        [inputs, handles, scene = scene.scene](Recorder& r) {
            inputs.set(r);
            r.vertex_buffer(handles.positions);
            r.index_buffer(handles.indices);
            for (std::size_t round = 0; round < rounds.size(); ++round) {
                draw_objects(r, *scene, handles, round);
            }
        });
    return samples;
}

}  // namespace gn
