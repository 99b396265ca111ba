// SPDX-License-Identifier: MIT
#include "shadow/geometry/edge_regions.h"

#include "shadow/casters/caster_draw.h"
#include "shadow/frame/frame.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/draw.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/geometry/seen_light.glsl"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/receiver/sent_points.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/casting.h"

#include <cmath>

namespace gn {
namespace {

/// As `frame_text` declares it.
struct GnEdgeRegion {
    mat4 cs_from_ws{1};
    vec4 light_ws{0};  ///< w = 1: the centre; w = 0: the direction towards it
    vec4 x_ws{0};      ///< the light's half axes; w > 0: a sphere of this radius
    vec4 y_ws{0};
    vec4 low_ws{0}, high_ws{0};  ///< bounds of what is seen
    vec2 size{0};                ///< of the picture, pixels
};

constexpr const char* frame_text = R"(
struct GnEdgeRegion {
    mat4 cs_from_ws;
    vec4 light_ws;
    vec4 x_ws;
    vec4 y_ws;
    vec4 low_ws;
    vec4 high_ws;
    vec2 size;
};
)";

GnEdgeRegion region_of(const FrameInput& input, float growth, vec2 size) {
    const GnLight& light = input.light().shape;
    GnEdgeRegion region{.cs_from_ws = input.samples.constants.cs_from_ws, .light_ws = light_point_ws(light)};
    const vec2 half_size = growth * glsl::gn_light_half_size(light);
    vec3 x(light.right_ws);
    vec3 y(light.up_ws);
    if (light.kind != GN_LIGHT_RECTANGLE) {
        complete_frame(vec3(light.direction_ws), x, y);
    }
    region.x_ws = vec4(x * half_size.x, light.kind == GN_LIGHT_POINT ? half_size.x : 0.0F);
    region.y_ws = vec4(y * half_size.y, 0);
    const Box bounds = seen_bounds(input);  // of what the samples are part of
    const vec3 margin(1e-4F * bounds.diagonal());
    region.low_ws = vec4(bounds.min - margin, 1);
    region.high_ws = vec4(bounds.max + margin, 1);
    region.size = size;
    return region;
}

/// `size`: of what the rectangles are drawn on, pixels.
ShaderInputs region_inputs(const FrameInput& input, const VolumeBuffers& buffers, const EdgeRegionPass& pass,
                           vec2 size) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", input.handles.positions)
        .buffer("readonly buffer", "Edges", "uvec2 edges[];", buffers.edges)
        .buffer("readonly buffer", "Sides", "uint sides[];", buffers.sides)
        .constant("GnEdgeRegion", "region", region_of(input, pass.growth, size));
    add_gbuffer(inputs, input.device, input.samples);
    inputs.add(pass.extra);
    return inputs;
}

// How the shader of the rectangles projects: onto the picture, whose near plane clips, or onto a light view, where nothing is
// nearer than rounding lets it be.
constexpr const char* picture_text = R"(
#define GN_EDGE_CLIP(p_ws) (u.region.cs_from_ws * (p_ws))
#define GN_EDGE_NEAR
)";
constexpr const char* view_text = R"(
layout(push_constant) uniform Push { int index; };
#define GN_EDGE_CLIP(p_ws) (views[index].cs_from_ws * (p_ws))
#define GN_EDGE_NEAR                                             \
    float farthest = 0.0;                                        \
    for (int i = 0; i < 10; ++i) {                               \
        farthest = max(farthest, abs(points_cs[i].w));           \
    }                                                            \
    for (int i = 0; i < 10; ++i) {                               \
        points_cs[i].z = 1.0e-5 * farthest;                      \
    }
)";

constexpr const char* varyings_text = R"(
layout(location = 0) flat in vec3 a_ws;
layout(location = 1) flat in vec3 b_ws;
layout(location = 2) flat in uint edge_index;
)";

constexpr const char* texel_text = R"(
void main() {
    ivec3 texel = ivec3(gl_FragCoord.xy, views[index].layer);
)";

constexpr const char* fragment_text = R"(
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 position = gbuffer_position_texel(pixel);
    if (position.w == 0.0) {
        discard;
    }
    vec3 p_ws = position.xyz;
    vec3 n_ws = gbuffer_normal_texel(pixel).xyz;
)";

constexpr const char* resolve_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(visibility)))) {
        return;
    }
    vec4 p_ws = gbuffer_position_texel(pixel);
    float v = 0.0;
    if (p_ws.w > 0.5 && gn_counted(u.light, p_ws.xyz, gbuffer_normal_texel(pixel).xyz)) {
        float hard = hard_texel(pixel).r;
        GN_SOFT soft = GN_SOFT(soft_texel(pixel));
        vec4 more = GN_MORE;
        v = clamp(GN_EDGE_RESOLVE, 0.0, 1.0);
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

/// The pipeline that draws the rectangles, where `projection` says on what, and `begin` how a fragment's main begins.
std::shared_ptr<const RasterDesc> region_pipeline(const FrameInput& input, const EdgeRegionPass& pass,
                                                  const ShaderInputs& inputs, const char* projection,
                                                  const char* begin) {
    const std::uint64_t key = hashed(inputs)
                                  .text(pass.name)
                                  .text(pass.includes)
                                  .text(pass.functions)
                                  .text(pass.fragment)
                                  .value(pass.blend)
                                  .finish()
                                  .low;
    return made_once(input.prepared, "edge regions", key, [&] {
        const std::string head = std::string(frame_text) + include_line("shadow/light_view.h") +
                                 include_line("shadow/geometry/seen_light.glsl") + std::string(pass.includes) +
                                 inputs.text() + projection;
        RasterDesc desc;
        desc.vertex = {ShaderKind::vertex, "edge-region.vert",
                       head + include_line("shadow/geometry/edge_regions.glsl")};
        desc.fragment = ShaderSource{ShaderKind::fragment, "edge-region.frag",
                                     fmt::format("{}\nlayout(location = 0) out {} result;\n{}{}{}{}}}\n", head,
                                                 pass.result, varyings_text, pass.functions, begin, pass.fragment)};
        desc.blend = pass.blend;
        return sealed(desc);
    });
}

}  // namespace

HardShadow add_hard_shadow(const FrameInput& input, bool closed) {
    HardShadow hard{add_all_silhouettes(input, closed), {}, {}};
    const TextureHandle receivers = add_receivers(input, hard.buffers);
    hard.counts = add_counts(input, hard.buffers, receivers);
    hard.visibility = add_count_resolve(input, hard.counts, {.masked = true});
    return hard;
}

void add_edge_regions(const FrameInput& input, const VolumeBuffers& buffers, const EdgeRegionPass& pass,
                      TextureHandle image, ClearValue clear) {
    const ShaderInputs inputs = region_inputs(input, buffers, pass, vec2(input.samples.width, input.samples.height));
    const auto pipeline = region_pipeline(input, pass, inputs, picture_text, fragment_text);
    input.graph.add_pass(
        std::string(pass.name),
        [&](PassBuilder& builder) {
            builder.color(image, Load::clear, clear);
            builder.indirect(buffers.draws);
            inputs.declare(builder);
        },
        [inputs, pipeline, draws = buffers.draws](Recorder& r) {
            r.bind(*pipeline);
            inputs.set(r);
            r.draw_indirect(draws, VkDeviceSize{strips_draw} * sizeof(std::uint32_t));
        });
}

void add_edge_texels(const FrameInput& input, const VolumeBuffers& buffers, const LightViews& views,
                     const EdgeRegionPass& pass, TextureHandle image) {
    GN_CHECK(!views.tiles && (views.kind == ViewKind::affine || views.kind == ViewKind::perspective));
    std::vector<bool> begun(views.layers, false);
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        const GnLightView& view = views.views[i];
        const auto layer = static_cast<std::uint32_t>(view.layer);
        ShaderInputs inputs = view_list(views);
        inputs.add(region_inputs(input, buffers, pass, view.resolution * vec2(view.rect_ts.z, view.rect_ts.w)));
        const auto pipeline = region_pipeline(input, pass, inputs, view_text, texel_text);
        input.graph.add_pass(
            std::string(pass.name),
            [&](PassBuilder& builder) {
                builder.color(image, begun[layer] ? Load::keep : Load::clear, {}, one_layer(layer));
                builder.indirect(buffers.draws);
                inputs.declare(builder);
            },
            [inputs, pipeline, draws = buffers.draws, view, index = static_cast<std::int32_t>(i)](Recorder& r) {
                set_viewport(r, view);
                r.bind(*pipeline);
                inputs.set(r);
                r.push_value(index);
                r.draw_indirect(draws, VkDeviceSize{strips_draw} * sizeof(std::uint32_t));
            });
        begun[layer] = true;
    }
}

std::vector<Side> edge_sides() {
    return {{"wedge-overdraw", "", "How many silhouette edges a pixel asks what they hide."}};
}

void add_edge_sides(const FrameInput& input, const VolumeBuffers& buffers, float growth, Visibility& told) {
    if (!holds(input.sides, "wedge-overdraw")) {
        return;
    }
    const TextureHandle image = input.graph.create(TextureDesc{.name = "wedge overdraw",
                                                               .format = VK_FORMAT_R32_SFLOAT,
                                                               .width = input.samples.width,
                                                               .height = input.samples.height});
    add_edge_regions(input, buffers,
                     {.name = "wedge overdraw",
                      .includes = "",
                      .functions = "",
                      .fragment = "    result = 1.0;\n",
                      .extra = {},
                      .growth = growth},
                     image, {});
    told.sides.push_back({"wedge-overdraw", image, {}});
}

std::string remark_masked(const Scene& scene, std::string_view part) {
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        if (is_masked(scene, scene.objects[i]) && casts(scene, i, nullptr)) {
            return fmt::format("{} finds no silhouettes of masked casters: their shadows keep hard edges", part);
        }
    }
    return "";
}

std::string remark_silhouettes(const Scene& scene, std::string_view part) {
    const std::string masked = remark_masked(scene, part);
    const std::string pictures = remark_pictures(scene, part);
    return masked + (masked.empty() || pictures.empty() ? "" : "; ") + pictures;
}

bool has_extent(const GnLight& light) {
    const vec2 size = glsl::gn_light_half_size(light);
    return size.x > 0.0F && size.y > 0.0F;
}

Visibility add_edge_resolve(const FrameInput& input, TextureHandle hard, TextureHandle soft,
                            const EdgeResolve& resolve) {
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2D", "hard", hard)
        .texels(input.device, input.graph.desc(soft).format, "2D", "soft", soft)
        .image("r32f", "writeonly", "image2D", "visibility", result.image)
        .constant("GnLight", "light", input.whole_light().shape);
    if (resolve.more.valid()) {
        inputs.texels(input.device, input.graph.desc(resolve.more).format, "2D", "more", resolve.more);
    }
    const auto shader = compute_once(input.prepared, resolve.name, hashed(inputs).text(resolve.expression), [&] {
        return fmt::format("#define GN_SOFT {}\n#define GN_MORE {}\n#define GN_EDGE_RESOLVE {}\n",
                           resolve.channels == 1 ? "float" : "vec4",
                           resolve.more.valid() ? "more_texel(pixel)" : "vec4(0.0)", resolve.expression) +
               include_line("shadow/scene/light.h") + std::string(resolve.includes) + inputs.text() + resolve_text;
    });
    add_pixel_pass(input.graph, std::string(resolve.name), inputs, shader, input.samples.width, input.samples.height);
    return result;
}

}  // namespace gn
