// SPDX-License-Identifier: MIT
// The edges of opaque casters, of which each view draws those where its light turns from one side of the surface to the
// other.
//
// Based on: Sen, Cammarano, Hanrahan. Shadow Silhouette Maps. SIGGRAPH 2003. [SCH03]
#include "shadow/map/silhouette_map/silhouette_edges.h"

#include "gpu/upload.h"
#include "shadow/casters/caster_draw.h"
#include "shadow/casters/tiles.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/edges.h"
#include "shadow/map/silhouette_map/silhouette_map.glsl"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/casting.h"

namespace gn {
namespace {

constexpr const char* fragment_text = R"(
#include "shadow/map/silhouette_map/silhouette_map.glsl"
layout(push_constant) uniform Push { int view; int map_layer; };
layout(location = 0) flat in vec4 in_segment;
layout(location = 1) flat in vec4 in_depth_over_w;
layout(location = 0) out vec4 out_point;
void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    vec2 a_cell = in_segment.xy - vec2(cell);
    vec2 b_cell = in_segment.zw - vec2(cell);
    float t = gn_silhouette_point(a_cell, b_cell);
    if (t < 0.0) {
        discard;
    }
    // A silhouette behind all four corners' surfaces casts nothing that they do not.
    vec2 over_w = mix(in_depth_over_w.xy, in_depth_over_w.zw, t);
    float depth = over_w.x / over_w.y;
    ivec2 last = textureSize(depth_map, 0).xy - 1;
    float deepest = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = min(cell + ivec2(i & 1, i >> 1), last);
        deepest = max(deepest, texelFetch(depth_map, ivec3(texel, map_layer), 0).r);
    }
    if (depth > deepest) {
        discard;
    }
    out_point = vec4(gn_silhouette_pack(mix(a_cell, b_cell, t)), 0.0, 0.0, 0.0);
    gl_FragDepth = clamp(depth, 0.0, 1.0);
}
)";

/// A scene's opaque edges on the GPU; lives as long as the passes that draw it.
struct SilhouetteEdges {
    std::uint32_t count = 0;
    Buffer edges, first, around;
};

SilhouetteEdges make_edges(Device& device, const Scene& scene, const std::vector<CasterKind>& kinds) {
    // Texture masks have no edges that geometry knows.
    std::vector<std::uint8_t> casts(scene.triangles.size(), 0);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const auto first = scene.objects[i].first_triangle, end = first + scene.objects[i].triangle_count;
        const auto opaque = is_single_sided(scene, scene.objects[i]) ? casts_from_its_front : casts_from_both_sides;
        std::fill(casts.begin() + first, casts.begin() + end, kinds[i] == CasterKind::opaque ? opaque : casts_nothing);
    }
    EdgeList list = build_edges(scene.positions_ws, scene.triangles, casts);
    for (std::uint32_t& user : list.around) {
        user |= casts[user >> 1U] == casts_from_its_front ? 1U << 31U : 0U;
    }
    return {.count = static_cast<std::uint32_t>(list.edges.size()),
            .edges = upload(device, "silhouette edges", list.edges),
            .first = upload(device, "silhouette edge starts", list.first),
            .around = upload(device, "silhouette edge triangles", list.around)};
}

/// Lights that the same objects cast for share the edges.
std::shared_ptr<const SilhouetteEdges> edges_of(const FrameInput& input) {
    const std::vector<CasterKind> kinds = caster_kinds(input);
    return input.derive("silhouette edges", casters_key(input.scene, kinds),
                        [&] { return make_edges(input.device, input.scene, kinds); });
}

struct EdgePush {
    int view, map_layer;
};

RasterDesc edge_pipeline(const ShaderInputs& inputs, bool tiles) {
    const std::string head =
        (tiles ? "#define GN_TILES\n" : "") + include_line("shadow/casters/tiles.glsl") + inputs.text();
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, "silhouettes.vert",
                   head + include_line("shadow/map/silhouette_map/silhouette_edges.glsl")};
    desc.fragment = ShaderSource{ShaderKind::fragment, "silhouettes.frag", head + fragment_text};
    desc.depth_test = desc.depth_write = true;
    desc.depth_compare = VK_COMPARE_OP_LESS;
    return sealed(std::move(desc));
}

/// What every view's pass draws with.
struct EdgeDraw {
    std::shared_ptr<const RasterDesc> shader;
    ShaderInputs inputs;
    BufferHandle tile_draw;  ///< with tiles
    std::uint32_t edges = 0;
};

void draw_edges(Recorder& r, const EdgeDraw& draw, const LightViews& views, const ViewPass& view) {
    if (!views.tiles) {
        const vec4 rect = views.views[view.index].rect_ts * views.views[view.index].resolution;
        r.scissor(static_cast<std::int32_t>(rect.x), static_cast<std::int32_t>(rect.y),
                  static_cast<std::uint32_t>(rect.z), static_cast<std::uint32_t>(rect.w));
    }
    r.bind(*draw.shader);
    draw.inputs.set(r);
    r.push_value(EdgePush{static_cast<int>(view.index), static_cast<int>(view.layer)});
    views.tiles ? r.draw_indirect(draw.tile_draw) : r.draw(6 * draw.edges);
}

}  // namespace

TextureHandle add_silhouette_points(const FrameInput& input, const LightViews& views, TextureHandle depth) {
    FrameGraph& graph = input.graph;
    TextureDesc desc = graph.desc(depth);
    desc.name = "silhouette points";
    desc.format = VK_FORMAT_R32_SFLOAT;
    desc.usage = 0;
    const TextureHandle points = graph.create(desc);
    desc.name = "silhouette depth";
    desc.format = VK_FORMAT_D32_SFLOAT;
    const TextureHandle nearest_edge = graph.create(desc);

    const std::shared_ptr<const SilhouetteEdges> edges = edges_of(input);
    ShaderInputs inputs = view_list(views);
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", input.handles.positions);
    inputs.buffer("readonly buffer", "Indices", "uvec3 triangles[];", input.handles.indices);
    inputs.buffer("readonly buffer", "Edges", "uvec2 edges[];", graph.import(edges->edges));
    inputs.buffer("readonly buffer", "First", "uint first[];", graph.import(edges->first));
    inputs.buffer("readonly buffer", "Around", "uint around[];", graph.import(edges->around));
    inputs.texture("sampler2DArray", "depth_map", depth);
    const auto shader = made_once(input.prepared, "silhouettes", views.tiles ? 1 : 0,
                                  [&] { return edge_pipeline(inputs, views.tiles); });
    const EdgeDraw draw{shader, inputs, views.tiles ? add_tile_draw(input, views, 6 * edges->count) : BufferHandle{},
                        edges->count};
    const ClearValue middle{.color = vec4(glsl::gn_silhouette_pack(vec2(0.5F)), 0, 0, 0)};
    LightViews drawn = views;
    drawn.layered = false;
    for (const ViewPass& view : view_passes(drawn)) {
        const Load load = view.first_of_layer ? Load::clear : Load::keep;
        graph.add_pass(
            "silhouettes",
            [&](PassBuilder& pass) {
                pass.color(points, load, middle, one_layer(view.layer));
                pass.depth(nearest_edge, load, {.depth = 1.0F}, one_layer(view.layer));
                if (views.tiles) {
                    pass.indirect(draw.tile_draw);
                }
                draw.inputs.declare(pass);
            },
            [edges, draw, views, view](Recorder& r) {
                if (draw.edges > 0) {
                    draw_edges(r, draw, views, view);
                }
            });
    }
    return points;
}

}  // namespace gn
