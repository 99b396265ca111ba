// SPDX-License-Identifier: MIT
#include "shadow/casters/caster_pipeline.h"

#include "shadow/receiver/sample_pass.h"

namespace gn {
namespace {

constexpr const char* vertex_text = R"(
layout(location = 0) in vec3 in_position_ws;
layout(push_constant, scalar) uniform Push { int view; float base_alpha; float alpha_cutoff; int object; int draw; } push;
#if defined(GN_FRAGMENT) && !defined(GN_CURVED)
layout(location = 0) out float out_depth;
#endif
#ifdef GN_TILES
layout(location = 7) flat out int out_view;
#ifndef GN_CURVED
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[4]; };
#endif
#endif
#ifdef GN_MASKED
layout(location = 1) out vec3 out_mask;  // uv, and the alpha of the vertices
#endif
void main() {
#ifdef GN_LAYERED
    int view = gl_InstanceIndex;
    gl_Layer = views[view].layer;
#elif defined(GN_TILES)
    int layer = push.view;
    int view = int(tile_lists[tile_lists[uint(push.draw)] + uint(gl_InstanceIndex)]);
    out_view = view;
#else
    int view = push.view;
#endif
    gl_Position = gn_clip(views[view], in_position_ws);
#ifdef GN_PARABOLOID
    // The frame of the light in units of depth; w carries the map's extent to the next stage.
    gl_Position = vec4(gl_Position.xyz / views[view].metres_per_depth, views[view].paraboloid);
#elif defined(GN_LOGARITHM)
    gl_Position.z = dot(views[view].depth_from_ws, vec4(in_position_ws, 1.0));
#elif defined(GN_FRAGMENT)
    out_depth = dot(views[view].depth_from_ws, vec4(in_position_ws, 1.0));
#endif
#if defined(GN_TILES) && defined(GN_CURVED)
    // A map without extent shows nothing.
    gl_Position.w = gn_tile_in(views[view], layer) ? gl_Position.w : 0.0;
#elif defined(GN_TILES)
    vec4 sides = gn_tile_sides(views[view], gl_Position, layer);
    gl_ClipDistance[0] = sides.x;
    gl_ClipDistance[1] = sides.y;
    gl_ClipDistance[2] = sides.z;
    gl_ClipDistance[3] = sides.w;
    gl_Position = gn_tile_clip(views[view], gl_Position);
#endif
#ifdef GN_MASKED
    out_mask = vec3(uvs[gl_VertexIndex], colors[min(gl_VertexIndex, colors.length() - 1)].a);
#endif
}
)";

// What geometry stages of views share in which edges are curved: each triangle becomes the rectangle around it.
constexpr const char* curved_text = R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;
#ifdef GN_MASKED
layout(location = 1) in vec3 in_mask[];
layout(location = 4) flat out vec3 out_mask_a;
layout(location = 5) flat out vec3 out_mask_b;
layout(location = 6) flat out vec3 out_mask_c;
#endif
#ifdef GN_TILES
layout(location = 7) flat in int in_view[];
layout(location = 7) flat out int out_view;
#endif

// Corner i of a rectangle (left, top, right, bottom) that winds as its triangle does, seen from the light.
vec2 corner_of(vec4 box, int i, float facing) {
    bool right = facing < 0.0 ? i >= 2 : (i & 1) != 0;
    bool below = facing < 0.0 ? (i & 1) != 0 : i >= 2;
    return vec2(right ? box.z : box.x, below ? box.w : box.y);
}

void emit_corner(vec2 p_ndc) {
#ifdef GN_MASKED
    out_mask_a = in_mask[0];
    out_mask_b = in_mask[1];
    out_mask_c = in_mask[2];
#endif
    gl_Position = vec4(p_ndc, 0.5, 1.0);
#ifdef GN_TILES
    out_view = in_view[0];
    gl_Position = gn_tile_clip(views[out_view], gl_Position);
#endif
    EmitVertex();
}
)";

// A triangle's edges are curved on a paraboloid. Its bounding rectangle is drawn, and every texel's ray meets the triangle
// itself: exact for triangles of any size, without subdividing them.
constexpr const char* paraboloid_text = R"(
#include "shadow/receiver/paraboloid.glsl"
layout(location = 0) out vec2 out_u;
layout(location = 1) flat out vec3 out_a;
layout(location = 2) flat out vec3 out_b;
layout(location = 3) flat out vec3 out_c;
void main() {
    vec3 a = gl_in[0].gl_Position.xyz;
    vec3 b = gl_in[1].gl_Position.xyz;
    vec3 c = gl_in[2].gl_Position.xyz;
    float extent = gl_in[0].gl_Position.w;
    vec4 box = gn_paraboloid_bounds(a, b, c, extent);
    float facing = dot(a, cross(b - a, c - a));
    if (extent <= 0.0 || box.x >= box.z || box.y >= box.w || facing == 0.0) {
        return;
    }
    for (int i = 0; i < 4; ++i) {
        out_u = corner_of(box, i, facing);
        out_a = a;
        out_b = b;
        out_c = c;
        emit_corner(out_u / extent);
    }
    EndPrimitive();
}
)";

constexpr const char* fragment_head = R"(
#include "shadow/receiver/logarithm.glsl"
#include "shadow/receiver/paraboloid.glsl"
layout(push_constant, scalar) uniform Push { int view; float base_alpha; float alpha_cutoff; int object; int draw; } push;
#ifdef GN_PARABOLOID
layout(location = 0) in vec2 in_u;
layout(location = 1) flat in vec3 in_a;
layout(location = 2) flat in vec3 in_b;
layout(location = 3) flat in vec3 in_c;
#elif defined(GN_LOGARITHM)
layout(location = 1) flat in vec4 in_a;
layout(location = 2) flat in vec4 in_b;
layout(location = 3) flat in vec4 in_c;
#else
layout(location = 0) in float in_depth;
#endif
#if defined(GN_MASKED) && defined(GN_CURVED)
layout(location = 4) flat in vec3 in_mask_a;
layout(location = 5) flat in vec3 in_mask_b;
layout(location = 6) flat in vec3 in_mask_c;
#elif defined(GN_MASKED)
layout(location = 1) in vec3 in_mask;
#endif
// Which view is drawn.
#if defined(GN_TILES)
layout(location = 7) flat in int caster_view;
#elif defined(GN_LAYERED)
#define caster_view gl_Layer
#else
#define caster_view push.view
#endif
)";

constexpr const char* fragment_main = R"(
void main() {
    // Before anything is discarded, while all neighbours are there, take the slope of the triangle's plane.
#ifdef GN_PARABOLOID
    vec2 change = gn_paraboloid_slope(in_u, in_a, in_b, in_c);
    vec2 slope = vec2(dot(change, dFdx(in_u)), dot(change, dFdy(in_u)));
    vec4 hit = gn_paraboloid_hit(in_u, in_a, in_b, in_c);
    if (hit.w < 0.0) {
        discard;
    }
    float in_depth = hit.w;
#elif defined(GN_LOGARITHM)
    float hit_rate = max(-views[caster_view].paraboloid, 0.0);
    vec4 hit_rect_ts = views[caster_view].rect_ts;
    vec2 hit_texel = 2.0 / (views[caster_view].resolution * hit_rect_ts.zw);
    vec2 hit_ndc = gn_log_ndc((gl_FragCoord.xy / views[caster_view].resolution - hit_rect_ts.xy) / hit_rect_ts.zw * 2.0 - 1.0, hit_rate);
    vec3 hit_depths = vec3(in_a.z, in_b.z, in_c.z);
    vec2 slope = gn_log_slope(hit_ndc, in_a.xyw, in_b.xyw, in_c.xyw, hit_depths, hit_rate) * hit_texel;
    vec4 hit = gn_log_hit(hit_ndc, in_a.xyw, in_b.xyw, in_c.xyw);
    if (hit.w < 0.0) {
        discard;
    }
    float in_depth = dot(hit.xyz, hit_depths);
#else
    vec2 slope = vec2(dFdx(in_depth), dFdy(in_depth));
#endif
#if defined(GN_MASKED) && defined(GN_CURVED)
    vec3 in_mask = hit.x * in_mask_a + hit.y * in_mask_b + hit.z * in_mask_c;
#endif
#ifdef GN_MASKED
    if (textureLod(base_color_texture, in_mask.xy, 0.0).a * push.base_alpha * in_mask.z < push.alpha_cutoff) {
        discard;
    }
#endif
    // What is clamped lies flat on the near plane.
    float depth = clamp(in_depth, 0.0, 1.0);
    slope = depth == in_depth ? slope : vec2(0.0);
#ifdef GN_WRITE_DEPTH
    gl_FragDepth = depth;
#ifdef GN_PUSHED
    gl_FragDepth = min(depth + 4.0 / 16777216.0, 1.0);
#endif
#endif
)";

}  // namespace

ShaderInputs caster_inputs(const LightViews& views, const SceneHandles& handles, bool masked, bool tiles,
                           BufferHandle tile_lists) {
    ShaderInputs inputs = view_list(views);
    if (tiles) {
        inputs.buffer("readonly buffer", "TileLists", "uint tile_lists[];", tile_lists);
    }
    if (masked) {
        inputs.buffer("readonly buffer", "Uvs", "vec2 uvs[];", handles.uvs)
            .buffer("readonly buffer", "Colors", "vec4 colors[];", handles.colors)
            .texture("sampler2D", "base_color_texture", handles.white);
    }
    return inputs;
}

RasterDesc caster_pipeline(const CasterPass& pass, const CasterVariant& variant) {
    const bool write_depth = variant.kind != ViewKind::affine;
    const bool paraboloid = variant.kind == ViewKind::paraboloid;
    const bool curved = paraboloid || variant.kind == ViewKind::logarithmic;
    const bool needs_fragment = variant.masked || write_depth || !pass.fragment.body.empty();
    // What a map's fragments read comes after what all stages do.
    const ShaderInputs shared = caster_inputs({}, {}, variant.masked, variant.tiles, {});
    ShaderInputs all = shared;
    all.add(pass.fragment.inputs);
    const std::string types = "#include \"shadow/casters/tiles.glsl\"\n";
    std::string defines;
    defines += needs_fragment ? "#define GN_FRAGMENT\n" : "";
    defines += variant.masked ? "#define GN_MASKED\n" : "";
    defines += write_depth ? "#define GN_WRITE_DEPTH\n" : "";
    defines += variant.layered ? "#define GN_LAYERED\n" : "";
    defines += variant.tiles ? "#define GN_TILES\n" : "";
    defines += curved ? "#define GN_CURVED\n" : "";
    defines += curved ? (paraboloid ? "#define GN_PARABOLOID\n" : "#define GN_LOGARITHM\n") : "";
    defines += variant.faces.pushed ? "#define GN_PUSHED\n" : "";

    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, pass.name + ".vert", defines + types + shared.text() + vertex_text};
    if (curved) {
        desc.geometry = ShaderSource{
            ShaderKind::geometry, pass.name + ".geom",
            defines + types + shared.text() + curved_text +
                (paraboloid ? std::string(paraboloid_text) : include_line("shadow/casters/caster_rows.glsl"))};
    }
    if (needs_fragment) {
        desc.fragment = ShaderSource{ShaderKind::fragment, pass.name + ".frag",
                                     defines + types + pass.fragment.includes + all.text() + fragment_head +
                                         fragment_main + pass.fragment.body + "\n}\n"};
    }
    desc.cull = variant.faces.culled;
    desc.depth_bias = variant.faces.pushed;
    desc.color_mask = variant.faces.depth_only ? 0 : 0xF;
    desc.depth_test = desc.depth_write = desc.depth_clamp = true;
    desc.depth_compare = VK_COMPARE_OP_LESS;
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
    desc.vertex_stride = sizeof(vec3);
    return desc;
}

}  // namespace gn
