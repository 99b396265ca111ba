// SPDX-License-Identifier: MIT
// Based on: Hasselgren, Akenine-Moeller, Ohlsson. Conservative Rasterization. GPU Gems 2, 2005. [HAO05]
#include "shadow/casters/conservative.h"

#include "shadow/casters/caster_draw.h"
#include "shadow/casters/tiles.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/casting.h"

namespace gn {
namespace {

constexpr const char* types_text = R"(
#include "shadow/light_view.h"
#include "shadow/casters/conservative.glsl"
)";

constexpr const char* slanted_vertex_text = R"(
layout(location = 0) in vec3 in_position_ws;
layout(push_constant, scalar) uniform Push { int view; int layer; uint first_triangle; } push;
layout(location = 0) out vec3 out_position;
layout(location = 1) flat out int out_view;
void main() {
    out_view = GN_TILES ? gl_InstanceIndex : push.view;
    out_position = gn_texel_position(views[out_view], gn_clip(views[out_view], in_position_ws));
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
)";

constexpr const char* geometry_text = R"(
#include "shadow/casters/tiles.glsl"
layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;
layout(push_constant, scalar) uniform Push { int view; int layer; uint first_triangle; } push;
layout(location = 0) in vec3 in_position[];
layout(location = 1) flat in int in_view[];
layout(location = 0) flat out vec3 out_a;
layout(location = 1) flat out vec3 out_b;
layout(location = 2) flat out vec3 out_c;
layout(location = 3) flat out vec3 out_slack;
layout(location = 4) flat out int out_view;
layout(location = 5) flat out uint out_triangle;
void main() {
    GnLightView view = views[in_view[0]];
    ivec4 own = gn_tile_texels(view);
    GnTexelEdges edges =
        gn_texel_edges(in_position[0], in_position[1], in_position[2], ivec4(own.xy, own.zw + 1));
    if (!gn_tile_in(view, push.layer) || edges.texels.x >= edges.texels.z || edges.texels.y >= edges.texels.w) {
        return;
    }
    // The rectangle of the texels that can be touched.
    for (int i = 0; i < 4; ++i) {
        vec2 corner = vec2((i & 1) == 0 ? edges.texels.x : edges.texels.z, (i & 2) == 0 ? edges.texels.y : edges.texels.w);
        out_a = edges.a;
        out_b = edges.b;
        out_c = edges.c;
        out_slack = edges.slack;
        out_view = in_view[0];
        out_triangle = push.first_triangle + uint(gl_PrimitiveIDIn);
        gl_Position = vec4(corner / view.resolution * 2.0 - 1.0, 0.5, 1.0);
        EmitVertex();
    }
    EndPrimitive();
}
)";

constexpr const char* touched_text = R"(
layout(location = 0) flat in vec3 in_a;
layout(location = 1) flat in vec3 in_b;
layout(location = 2) flat in vec3 in_c;
layout(location = 3) flat in vec3 in_slack;
layout(location = 4) flat in int caster_view;
layout(location = 5) flat in uint triangle;
layout(location = 0) out vec4 out_color;
)";

constexpr const char* touched_main = R"(
void main() {
    ivec3 texel = ivec3(ivec2(gl_FragCoord.xy), views[caster_view].layer);
    out_color = vec4(0.0);
    GnTexelEdges edges = GnTexelEdges(in_a, in_b, in_c, in_slack, ivec4(texel.xy, texel.xy + 1));
    if (!gn_touches(edges, texel.xy)) {
        discard;
    }
)";

RasterDesc pipeline(const ConservativePass& pass, bool tiles) {
    const ShaderInputs views = view_list({});
    ShaderInputs all = views;
    all.add(pass.inputs);
    const std::string head = fmt::format("#define GN_TILES {}\n", tiles) + types_text;
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, pass.name + ".vert", head + views.text() + slanted_vertex_text};
    desc.geometry = ShaderSource{ShaderKind::geometry, pass.name + ".geom", head + views.text() + geometry_text};
    desc.fragment = ShaderSource{
        ShaderKind::fragment, pass.name + ".frag",
        head + pass.includes + all.text() + touched_text + pass.functions + touched_main + pass.body + "\n}\n"};
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
    desc.vertex_stride = sizeof(vec3);
    return sealed(std::move(desc));
}

/// All that its text depends on.
std::uint64_t key_of(const ConservativePass& pass, bool tiles) {
    Hasher hasher = hashed(pass.inputs);
    hasher.text(pass.name).text(pass.includes).text(pass.functions).text(pass.body).value(tiles);
    return hasher.finish().low;
}

struct ConservativePush {
    std::int32_t view, layer;
    std::uint32_t first_triangle;
};

}  // namespace

void add_conservative_passes(const FrameInput& input, const LightViews& views, const ConservativePass& pass) {
    GN_CHECK(views.kind == ViewKind::affine || views.kind == ViewKind::perspective);
    if (input.handles.drawn != nullptr) {
        refuse(
            "pass '{}' asks which texels a triangle touches, which draws of a renderer's own do not tell; lend buffers",
            pass.name);
    }
    LightViews drawn = views;
    drawn.layered = false;
    const BufferHandle draws = views.tiles ? add_tile_draws(input, views) : BufferHandle{};
    ShaderInputs inputs = view_list(drawn);
    inputs.add(pass.inputs);
    const auto shader = made_once(input.prepared, "conservative", key_of(pass, views.tiles),
                                  [&] { return pipeline(pass, views.tiles); });
    const std::vector<std::uint32_t> objects = casters(input.scene, input.light());
    for (const ViewPass& view : view_passes(drawn)) {
        input.graph.add_pass(
            pass.name,
            [&](PassBuilder& builder) {
                builder.color(pass.color, view.first_of_layer ? Load::clear : Load::keep, {}, one_layer(view.layer));
                builder.vertices(input.handles.positions);
                builder.indices(input.handles.indices);
                inputs.declare(builder);
                if (drawn.tiles) {
                    builder.indirect(draws);
                }
            },
            [drawn, view, objects, draws, inputs, shader, handles = input.handles, scene = &input.scene](Recorder& r) {
                r.bind(*shader);
                inputs.set(r);
                r.vertex_buffer(handles.positions);
                r.index_buffer(handles.indices);
                for (const std::uint32_t index : objects) {
                    const Object& object = scene->objects[index];
                    r.push_value(ConservativePush{static_cast<std::int32_t>(view.index),
                                                  static_cast<std::int32_t>(view.layer), object.first_triangle});
                    if (drawn.tiles) {
                        r.draw_indexed_indirect(draws, index * sizeof(VkDrawIndexedIndirectCommand));
                    } else {
                        r.draw_indexed(object.triangle_count * 3, 1, object.first_triangle * 3);
                    }
                }
            });
    }
}

}  // namespace gn
