// SPDX-License-Identifier: MIT
// The edges of opaque casters, of which each view draws those where its light turns from one side of the surface to the
// other.
//
// Based on: Sen, Cammarano, Hanrahan. Shadow Silhouette Maps. SIGGRAPH 2003. [SCH03]
#include "shadow/map/silhouette_map/silhouette_edges.h"

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

constexpr const char* vertex_text = R"(
#ifdef GN_TILES
layout(push_constant) uniform Push { int layer; };
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[4]; };
#else
layout(push_constant) uniform Push { int view; };
#endif
layout(location = 0) flat out vec4 out_segment;     // ends, in cells
layout(location = 1) flat out vec4 out_depth_over_w;  // depth / w and 1 / w of both ends

// Which side of its plane a triangle turns to the light.
int side(uvec3 corners, vec4 eye_ws) {
    vec3 a = positions[corners.x];
    vec3 n = cross(positions[corners.y] - a, positions[corners.z] - a);
    return int(sign(dot(n, eye_ws.xyz - a * eye_ws.w)));
}

// [SCH03] 3: an edge is a silhouette where the directions in which lit sides run through it do not cancel.
bool is_silhouette(uint edge, vec4 eye_ws) {
    int sum = 0;
    for (uint i = first[edge]; i < first[edge + 1u]; ++i) {
        int s = side(triangles[(around[i] & 0x7fffffffu) >> 1], eye_ws);
        // The highest bit: a triangle that casts from its front alone is not there from behind.
        s = (around[i] & 0x80000000u) != 0u ? max(s, 0) : s;
        sum += (around[i] & 1u) != 0u ? -s : s;
    }
    return sum != 0;
}

// Cuts [t.x, t.y] to where a linear function with these values at both ends is positive.
void clip(inout vec2 t, float at_a, float at_b) {
    float crossing = at_a == at_b ? 0.0 : at_a / (at_a - at_b);
    if (at_a < 0.0) {
        t.x = at_b < 0.0 ? 2.0 : max(t.x, crossing);
    } else if (at_b < 0.0) {
        t.y = min(t.y, crossing);
    }
}

void main() {
    uint edge = uint(gl_VertexIndex) / 6u;
#ifdef GN_TILES
    GnLightView v = views[gl_InstanceIndex];
    gl_ClipDistance = float[](-1.0, -1.0, -1.0, -1.0);
#else
    GnLightView v = views[view];
#endif
    gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
    out_segment = vec4(0.0);
    out_depth_over_w = vec4(0.0, 1.0, 0.0, 1.0);
    if (!is_silhouette(edge, v.eye_ws)) {
        return;
    }
    // Cut off what lies behind the light or far beside its view.
    vec3 a_ws = positions[edges[edge].x];
    vec3 b_ws = positions[edges[edge].y];
    vec4 a_cs = gn_clip(v, a_ws);
    vec4 b_cs = gn_clip(v, b_ws);
    vec2 t = vec2(0.0, 1.0);
    float least_w = v.eye_ws.w > 0.5 ? 1.0e-5 * v.metres_per_depth : 1.0e-4;
    clip(t, a_cs.w - least_w, b_cs.w - least_w);
    clip(t, 1.5 * a_cs.w - a_cs.x, 1.5 * b_cs.w - b_cs.x);
    clip(t, 1.5 * a_cs.w + a_cs.x, 1.5 * b_cs.w + b_cs.x);
    clip(t, 1.5 * a_cs.w - a_cs.y, 1.5 * b_cs.w - b_cs.y);
    clip(t, 1.5 * a_cs.w + a_cs.y, 1.5 * b_cs.w + b_cs.y);
    if (t.x >= t.y) {
        return;
    }
    float a_depth = dot(v.depth_from_ws, vec4(a_ws, 1.0));
    float b_depth = dot(v.depth_from_ws, vec4(b_ws, 1.0));
    vec2 depths = vec2(mix(a_depth, b_depth, t.x), mix(a_depth, b_depth, t.y));
    vec4 from_cs = mix(a_cs, b_cs, t.x);
    vec4 to_cs = mix(a_cs, b_cs, t.y);
    out_depth_over_w = vec4(depths.x / from_cs.w, 1.0 / from_cs.w, depths.y / to_cs.w, 1.0 / to_cs.w);

    // From clip space to cells, which lie half a texel off the texels.
    vec2 from = (v.rect_ts.xy + (from_cs.xy / from_cs.w * 0.5 + 0.5) * v.rect_ts.zw) * v.resolution - 0.5;
    vec2 to = (v.rect_ts.xy + (to_cs.xy / to_cs.w * 0.5 + 0.5) * v.rect_ts.zw) * v.resolution - 0.5;
    out_segment = vec4(from, to);

    // Draw a quad that holds the centre of every cell the segment touches: all around it three quarters of a cell.
    vec2 along = distance(from, to) > 1.0e-6 ? normalize(to - from) * 0.75 : vec2(0.75, 0.0);
    vec2 across = vec2(-along.y, along.x);
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexIndex % 6];
    vec2 p = (corner & 1) == 0 ? from - along : to + along;
    p += (corner & 2) == 0 ? -across : across;
    gl_Position = vec4(p / v.resolution * 2.0 - 1.0, 0.5, 1.0);
#ifdef GN_TILES
    vec4 rect = v.rect_ts * v.resolution;
    if (gn_tile_in(v, layer)) {
        gl_ClipDistance = float[](p.x - rect.x, rect.x + rect.z - p.x, p.y - rect.y, rect.y + rect.w - p.y);
    }
#endif
}
)";

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

template <class T>
Buffer upload(Device& device, const char* name, const std::vector<T>& values) {
    return upload_buffer(
        device, {.name = name, .bytes = values.size() * sizeof(T), .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
        std::as_bytes(std::span(values)));
}

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

struct Push {
    int view, map_layer;
};

RasterDesc edge_pipeline(const ShaderInputs& inputs, bool tiles) {
    const std::string head =
        (tiles ? "#define GN_TILES\n" : "") + include_line("shadow/casters/tiles.glsl") + inputs.text();
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, "silhouettes.vert", head + vertex_text};
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
    r.push_value(Push{static_cast<int>(view.index), static_cast<int>(view.layer)});
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
