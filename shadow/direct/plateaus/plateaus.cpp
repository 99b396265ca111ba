// SPDX-License-Identifier: MIT
// The hard shadow on a plane as the top of a plateau, whose slopes are the penumbra.
//
// Based on: Haines. Soft Planar Shadows Using Plateaus. Journal of Graphics Tools 2001. [Hai01]
// Departs from it: slopes are evaluated where samples see the plane, and the darkest wins by blending, not in a depth buffer of the
// plane's own texture.
#include "shadow/direct/plateaus/plateaus.h"

#include "shadow/geometry/edge_regions.h"
#include "shadow/geometry/flattened.h"
#include "shadow/geometry/seen_light.glsl"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn::parts::plateaus {
namespace {

constexpr const char* vertex_text = R"(
layout(location = 0) flat out vec4 a_ws;  // the shadow of an end, and its width
layout(location = 1) flat out vec4 b_ws;
void main() {
    uint side = sides[uint(gl_VertexIndex) / 6u];
    uint corner = uint(gl_VertexIndex) % 6u;
    corner = corner < 3u ? corner : corner == 3u ? 2u : corner == 4u ? 1u : 3u;
    vec3 a = positions[edges[side >> 1].x];
    vec3 b = positions[edges[side >> 1].y];
    gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
    a_ws = vec4(0.0);
    b_ws = vec4(0.0);
    if (!gn_plateaus_cut(u.frame.plane_ws, u.frame.light_ws, a, b)) {
        return;
    }
    vec4 on_a = gn_plane_project(u.frame.plane_ws, u.frame.light_ws, a);
    vec4 on_b = gn_plane_project(u.frame.plane_ws, u.frame.light_ws, b);
    a_ws = vec4(on_a.xyz / on_a.w, gn_plateaus_width(u.frame.plane_ws, u.frame.light_ws, u.size, a));
    b_ws = vec4(on_b.xyz / on_b.w, gn_plateaus_width(u.frame.plane_ws, u.frame.light_ws, u.size, b));
    // The rectangle around cones and sheet, on the plane.
    float reach = max(a_ws.w, b_ws.w);
    vec3 along = b_ws.xyz - a_ws.xyz;
    vec3 x_ws;
    vec3 y_ws;
    gn_across(u.frame.plane_ws.xyz, x_ws, y_ws);
    x_ws = dot(along, along) > 0.0 ? normalize(along) : x_ws;
    y_ws = cross(u.frame.plane_ws.xyz, x_ws);
    vec3 end_ws = (corner & 1u) != 0u ? b_ws.xyz + x_ws * reach : a_ws.xyz - x_ws * reach;
    gl_Position = u.frame.cs_from_ws * vec4(end_ws + ((corner & 2u) != 0u ? y_ws : -y_ws) * reach, 1.0);
    gl_Position.z = 0.5 * gl_Position.w;
}
)";

constexpr const char* fragment_text = R"(
layout(location = 0) flat in vec4 a_ws;
layout(location = 1) flat in vec4 b_ws;
layout(location = 0) out float light;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 p_ws = gbuffer_position_texel(pixel);
    if (p_ws.w == 0.0 || !gn_on_plane(u.frame.plane_ws, u.frame.tolerance, p_ws.xyz, gbuffer_normal_texel(pixel).xyz)) {
        discard;
    }
    light = gn_plateaus_light(p_ws.xyz, a_ws.xyz, a_ws.w, b_ws.xyz, b_ws.w);
}
)";

/// One radius for the light: cones are round. A rectangle's is the mean of its half sizes.
float size_of(const GnLight& light) {
    const vec2 half_size = glsl::gn_light_half_size(light);
    return 0.5F * (half_size.x + half_size.y);
}

ShaderInputs slope_inputs(const FrameInput& input, const VolumeBuffers& buffers, const GnFlattening& plane) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", input.handles.positions)
        .buffer("readonly buffer", "Edges", "uvec2 edges[];", buffers.edges)
        .buffer("readonly buffer", "Sides", "uint sides[];", buffers.sides)
        .constant("GnFlattening", "frame", plane)
        .constant("float", "size", size_of(input.light().shape));
    add_gbuffer(inputs, input.device, input.samples);
    return inputs;
}

/// The slopes of all planes, the darkest of each sample.
TextureHandle add_slopes(const FrameInput& input, const VolumeBuffers& buffers, const ReceiverPlanes& found) {
    const LitPlanes lit = lit_planes(input.samples.constants.cs_from_ws, found, light_point_ws(input.light().shape));
    std::vector<ShaderInputs> inputs;
    for (const GnFlattening& plane : lit.planes) {
        inputs.push_back(slope_inputs(input, buffers, plane));
    }
    const ShaderInputs declared = slope_inputs(input, buffers, {});
    const auto pipeline = made_once(input.prepared, "plateaus", hashed(declared).finish().low, [&] {
        const std::string head = include_line("shadow/direct/plateaus/plateaus.glsl") +
                                 include_line("shadow/geometry/seen_light.glsl") + declared.text();
        RasterDesc desc;
        desc.vertex = {ShaderKind::vertex, "plateaus.vert", head + vertex_text};
        desc.fragment = ShaderSource{ShaderKind::fragment, "plateaus.frag", head + fragment_text};
        desc.blend = Blend::min;
        return sealed(desc);
    });
    const TextureHandle image = input.graph.create(TextureDesc{.name = "plateaus slopes",
                                                               .format = VK_FORMAT_R32_SFLOAT,
                                                               .width = input.samples.width,
                                                               .height = input.samples.height});
    input.graph.add_pass(
        "plateaus: slopes",
        [&](PassBuilder& pass) {
            pass.color(image, Load::clear, {.color = vec4(1)});
            pass.indirect(buffers.draws);
            declared.declare(pass);
        },
        [inputs, pipeline, draws = buffers.draws](Recorder& r) {
            for (const ShaderInputs& plane : inputs) {
                r.bind(*pipeline);
                plane.set(r);
                r.draw_indirect(draws, VkDeviceSize{strips_draw} * sizeof(std::uint32_t));
            }
        });
    return image;
}

Visibility add_plateaus(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnPlateausParams>("plateaus");
    const auto found = flat_receivers(input, {params.planes, params.min_area, params.tolerance}, "plateaus");
    const Visibility hard = add_flat_shadow(input, *found);
    if (!has_extent(input.light().shape)) {
        return hard;
    }
    const VolumeBuffers buffers = add_all_silhouettes(input);
    return add_edge_resolve(input, hard.image, add_slopes(input, buffers, *found),
                            {.name = "plateaus: resolve", .includes = "", .expression = "min(hard, soft)"});
}

}  // namespace
}  // namespace gn::parts::plateaus

namespace gn::parts {

const Part& direct_plateaus() {
    using namespace plateaus;
    static const Part part = [] {
        Part p;
        p.id = "plateaus";
        p.stage = Stage::direct;
        p.title = "Soft planar shadows by plateaus";
        p.citation = "Hai01";
        p.features = {Feature::depth32_stencil8, Feature::float32_blend};
        p.needs_scene = true;
        p.params = param_table<GnPlateausParams>({
            GN_PARAM(GnPlateausParams, planes, integer, 1, 64, "",
                     "More flat receivers get shadows, each for one more drawing of all casters and edges."),
            GN_PARAM(GnPlateausParams, min_area, real, 0, 1, "of the scene's surface",
                     "Smaller flat parts stay without shadow."),
            GN_PARAM(GnPlateausParams, tolerance, real, 1e-7, 1e-2, "of the scene's diagonal",
                     "Rougher planes receive; what stands lower than this above one casts nothing."),
        });
        p.params_type = "GnPlateausParams";
        p.glsl = "shadow/direct/plateaus/plateaus.glsl";
        p.add_direct = add_plateaus;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
