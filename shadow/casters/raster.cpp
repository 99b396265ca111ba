// SPDX-License-Identifier: MIT
#include "shadow/casters/raster.h"

#include "shadow/casters/caster_draw.h"
#include "shadow/scene/casting.h"
#include "shadow/view/draw.h"

#include <algorithm>

namespace gn {
namespace {

constexpr const char* vertex_text = R"(
#include "shadow/light_view.h"
layout(location = 0) in vec3 in_position_ws;
layout(binding = 0, scalar) readonly buffer Views { GnLightView views[]; };
layout(push_constant, scalar) uniform Push { int view; float base_alpha; float alpha_cutoff; int object; } push;
#if defined(GN_FRAGMENT) && !defined(GN_PARABOLOID)
layout(location = 0) out float out_depth;
#endif
#ifdef GN_MASKED
layout(binding = 1, scalar) readonly buffer Uvs { vec2 uvs[]; };
layout(binding = 9, scalar) readonly buffer Colors { vec4 colors[]; };
layout(location = 1) out vec3 out_mask;  // uv, and the alpha of the vertices
#endif
void main() {
#ifdef GN_LAYERED
    int view = gl_InstanceIndex;
    gl_Layer = views[view].layer;
#else
    int view = push.view;
#endif
    gl_Position = gn_clip(views[view], in_position_ws);
#ifdef GN_PARABOLOID
    // The frame of the light in units of depth; w carries the map's extent to the next stage.
    gl_Position = vec4(gl_Position.xyz / views[view].metres_per_depth, views[view].paraboloid);
#elif defined(GN_FRAGMENT)
    out_depth = dot(views[view].depth_from_ws, vec4(in_position_ws, 1.0));
#endif
#ifdef GN_MASKED
    out_mask = vec3(uvs[gl_VertexIndex], colors[min(gl_VertexIndex, colors.length() - 1)].a);
#endif
}
)";

// A triangle's edges are curved on a paraboloid. Its bounding rectangle is drawn, and every texel's ray meets the triangle
// itself: exact for triangles of any size, without subdividing them.
constexpr const char* paraboloid_text = R"(
#include "shadow/receiver/paraboloid.glsl"
layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = 0) out vec2 out_u;
layout(location = 1) flat out vec3 out_a;
layout(location = 2) flat out vec3 out_b;
layout(location = 3) flat out vec3 out_c;
#ifdef GN_MASKED
layout(location = 1) in vec3 in_mask[];
layout(location = 4) flat out vec3 out_mask_a;
layout(location = 5) flat out vec3 out_mask_b;
layout(location = 6) flat out vec3 out_mask_c;
#endif
void main() {
    vec3 a = gl_in[0].gl_Position.xyz;
    vec3 b = gl_in[1].gl_Position.xyz;
    vec3 c = gl_in[2].gl_Position.xyz;
    float extent = gl_in[0].gl_Position.w;
    vec4 box = gn_paraboloid_bounds(a, b, c, extent);
    float facing = dot(a, cross(b - a, c - a));
    if (box.x >= box.z || box.y >= box.w || facing == 0.0) {
        return;
    }
    // The rectangle winds as the triangle does, seen from the light.
    for (int i = 0; i < 4; ++i) {
        bool right = facing < 0.0 ? i >= 2 : (i & 1) != 0;
        bool below = facing < 0.0 ? (i & 1) != 0 : i >= 2;
        out_u = vec2(right ? box.z : box.x, below ? box.w : box.y);
        out_a = a;
        out_b = b;
        out_c = c;
#ifdef GN_MASKED
        out_mask_a = in_mask[0];
        out_mask_b = in_mask[1];
        out_mask_c = in_mask[2];
#endif
        gl_Position = vec4(out_u / extent, 0.5, 1.0);
        EmitVertex();
    }
    EndPrimitive();
}
)";

/// Bindings of the blocks and textures that every caster shader reads; a map's own come after them.
constexpr unsigned caster_bindings = 3;

constexpr const char* fragment_head = R"(
#include "shadow/light_view.h"
#include "shadow/receiver/paraboloid.glsl"
layout(binding = 0, scalar) readonly buffer Views { GnLightView views[]; };
layout(push_constant, scalar) uniform Push { int view; float base_alpha; float alpha_cutoff; int object; } push;
#ifdef GN_MASKED
layout(binding = 2) uniform sampler2D base_color_texture;
#endif
#ifdef GN_PARABOLOID
layout(location = 0) in vec2 in_u;
layout(location = 1) flat in vec3 in_a;
layout(location = 2) flat in vec3 in_b;
layout(location = 3) flat in vec3 in_c;
#ifdef GN_MASKED
layout(location = 4) flat in vec3 in_mask_a;
layout(location = 5) flat in vec3 in_mask_b;
layout(location = 6) flat in vec3 in_mask_c;
#endif
#else
layout(location = 0) in float in_depth;
#ifdef GN_MASKED
layout(location = 1) in vec3 in_mask;
#endif
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
#ifdef GN_MASKED
    vec3 in_mask = hit.x * in_mask_a + hit.y * in_mask_b + hit.z * in_mask_c;
#endif
#else
    vec2 slope = vec2(dFdx(in_depth), dFdy(in_depth));
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

struct Push {
    int view;
    float base_alpha, alpha_cutoff;
    int object;
};

struct Variant {
    bool masked = false, write_depth = false, layered = false, paraboloid = false;
    CasterFaces faces;
};

/// How far faces that must lose ties are pushed: units of the depth's last place at the farthest corner, and pixels of the
/// rasterizer's grid, four each as in the view's samples.
constexpr float push_units = 4;
constexpr float push_pixels = 4.0F / 256;

/// The pipeline that draws casters: a fragment stage only where depth is not affine, alpha is tested or the map asks.
RasterDesc caster_pipeline(const CasterPass& pass, const Variant& variant) {
    const bool needs_fragment = variant.masked || variant.write_depth || !pass.fragment.body.empty();
    std::string defines;
    defines += needs_fragment ? "#define GN_FRAGMENT\n" : "";
    defines += variant.masked ? "#define GN_MASKED\n" : "";
    defines += variant.write_depth ? "#define GN_WRITE_DEPTH\n" : "";
    defines += variant.layered ? "#define GN_LAYERED\n" : "";
    defines += variant.paraboloid ? "#define GN_PARABOLOID\n" : "";
    defines += variant.faces.pushed ? "#define GN_PUSHED\n" : "";

    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, pass.name + ".vert", defines + vertex_text};
    if (variant.paraboloid) {
        desc.geometry = ShaderSource{ShaderKind::geometry, pass.name + ".geom", defines + paraboloid_text};
    }
    if (needs_fragment) {
        desc.fragment =
            ShaderSource{ShaderKind::fragment, pass.name + ".frag",
                         defines + pass.fragment.includes + fragment_head + pass.fragment.inputs.text(caster_bindings) +
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

}  // namespace

void set_viewport(Recorder& r, const GnLightView& view) {
    const float n = view.resolution;
    r.viewport(view.rect_ts.x * n, view.rect_ts.y * n, view.rect_ts.z * n, view.rect_ts.w * n);
    r.scissor(static_cast<std::int32_t>(view.rect_ts.x * n), static_cast<std::int32_t>(view.rect_ts.y * n),
              static_cast<std::uint32_t>(view.rect_ts.z * n), static_cast<std::uint32_t>(view.rect_ts.w * n));
}

void CasterDraw::begin(Recorder& r, const CasterFaces& faces, bool masked) const {
    const GnLightView& first = views.views[view];
    r.bind(caster_pipeline(pass, {masked, first.affine_depth == 0, views.layered, first.paraboloid > 0, faces}));
    r.depth_bias(push_units, push_pixels);
    set_views(r, views);
    pass.fragment.inputs.set(r);
    r.vertex_buffer(handles.positions);
    r.index_buffer(handles.indices);
}

void CasterDraw::opaque(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const {
    if (pass.by_object) {
        opaque_one_by_one(r, faces, objects);
        return;
    }
    const std::vector<DrawRange> runs = opaque_runs(*scene, objects);
    if (runs.empty()) {
        return;
    }
    begin(r, faces, false);
    r.push_value(Push{static_cast<int>(view), 1.0F, 0.0F, -1});
    for (const DrawRange& run : runs) {
        r.draw_indexed(run.index_count, instances(), run.first_index);
    }
}

void CasterDraw::opaque_one_by_one(Recorder& r, const CasterFaces& faces,
                                   std::span<const std::uint32_t> objects) const {
    if (objects.empty()) {
        return;
    }
    begin(r, faces, false);
    for (const std::uint32_t index : objects) {
        const Object& object = scene->objects[index];
        if (!is_masked(*scene, object)) {
            r.push_value(Push{static_cast<int>(view), 1.0F, 0.0F, static_cast<int>(index)});
            r.draw_indexed(object.triangle_count * 3, instances(), object.first_triangle * 3);
        }
    }
}

void CasterDraw::masked(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const {
    const std::vector<std::uint32_t> masked = masked_objects(*scene, objects);
    if (masked.empty()) {
        return;
    }
    begin(r, faces, true);
    r.set("Uvs", handles.uvs);
    r.set("Colors", handles.colors);
    for (const std::uint32_t index : masked) {
        const Object& object = scene->objects[index];
        const Material& material = scene->materials[static_cast<std::size_t>(object.material)];
        const BaseColor color = base_color(*scene, handles, material);
        const AlphaTest test = alpha_test(material);
        r.set("base_color_texture", color.texture, color.sampler);
        r.push_value(Push{static_cast<int>(view), test.base_alpha, test.cutoff, static_cast<int>(index)});
        r.draw_indexed(object.triangle_count * 3, instances(), object.first_triangle * 3);
    }
}

std::vector<std::uint32_t> CasterDraw::objects() const {
    if (views.casters.empty()) {
        return casters(*scene, *light);
    }
    // One pass for all layers draws what any of them needs.
    std::vector<std::uint32_t> found;
    for (std::size_t i = views.layered ? 0 : view; i <= (views.layered ? views.casters.size() - 1 : view); ++i) {
        found.insert(found.end(), views.casters[i].begin(), views.casters[i].end());
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::erase_if(found, [&](std::uint32_t object) { return !casts(*scene, object, light); });
    return found;
}

void CasterDraw::draw(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const {
    opaque(r, faces, objects);
    masked(r, faces, objects);
}

void CasterDraw::record(Recorder& r) const {
    constexpr CasterFaces fronts{.culled = VK_CULL_MODE_BACK_BIT};
    constexpr CasterFaces backs{.culled = VK_CULL_MODE_FRONT_BIT};
    const std::vector<std::uint32_t> drawn = objects();
    if (recipe.casters == Casters::front || recipe.casters == Casters::back) {
        draw(r, recipe.casters == Casters::front ? fronts : backs, drawn);
        return;
    }

    // A material with one side casts from that side only.
    std::vector<std::uint32_t> both;
    std::vector<std::uint32_t> one;
    for (const std::uint32_t object : drawn) {
        (is_single_sided(*scene, scene->objects[object]) && !pass.every_side ? one : both).push_back(object);
    }
    if (!pass.by_object) {
        draw(r, {}, both);
        draw(r, fronts, one);
        return;
    }

    // Of two faces back to back the one turned to the light gives its name: backs come later and pushed away, and their
    // own depth last.
    draw(r, fronts, drawn);
    draw(r, {.culled = backs.culled, .pushed = true}, both);
    draw(r, {.culled = backs.culled, .depth_only = true}, both);
}

void CasterDraw::declare(PassBuilder& builder) const {
    builder.vertices(handles.positions);
    builder.indices(handles.indices);
    builder.storage_read(handles.uvs);
    builder.storage_read(handles.colors);
    sample_textures(builder, handles);
    declare_views(builder, views);
    pass.fragment.inputs.declare(builder);
}

void add_caster_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass) {
    if (can_keep(input, views, pass)) {
        add_kept_passes(input, recipe, views, pass);
        return;
    }
    std::vector<bool> cleared(views.layers, false);
    for (std::size_t view = 0; view < (views.layered ? 1 : views.views.size()); ++view) {
        const auto layer = static_cast<std::uint32_t>(views.views[view].layer);
        const Load load = cleared[layer] ? Load::keep : Load::clear;
        cleared[layer] = true;
        const Range range = views.layered ? Range{0, 1, 0, views.layers} : one_layer(layer);
        const CasterDraw draw{pass, recipe, views, input.handles, &input.scene, &input.light(), view};
        input.graph.add_pass(
            pass.name,
            [&](PassBuilder& builder) {
                if (pass.color.valid()) {
                    builder.color(pass.color, load, pass.clear_color, range);
                }
                builder.depth(pass.depth, load, {.depth = 1.0F}, range);
                draw.declare(builder);
            },
            [draw](Recorder& r) {
                set_viewport(r, draw.views.views[draw.view]);
                draw.record(r);
            });
    }
}

}  // namespace gn
