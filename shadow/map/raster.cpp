// SPDX-License-Identifier: MIT
#include "shadow/map/raster.h"

#include "shadow/view/draw.h"

namespace gn {
namespace {

constexpr const char* vertex_text = R"(
#include "shadow/light_view.h"
layout(location = 0) in vec3 in_position_ws;
layout(binding = 0, scalar) readonly buffer Views { GnLightView views[]; };
layout(push_constant, scalar) uniform Push { int view; float base_alpha; float alpha_cutoff; } push;
#ifdef GN_FRAGMENT
layout(location = 0) out float out_depth;
#endif
#ifdef GN_MASKED
layout(binding = 1, scalar) readonly buffer Uvs { vec2 uvs[]; };
layout(location = 1) out vec2 out_uv;
#endif
void main() {
    gl_Position = views[push.view].cs_from_ws * vec4(in_position_ws, 1.0);
#ifdef GN_FRAGMENT
    out_depth = dot(views[push.view].depth_from_ws, vec4(in_position_ws, 1.0));
#endif
#ifdef GN_MASKED
    out_uv = uvs[gl_VertexIndex];
#endif
}
)";

constexpr const char* fragment_head = R"(
layout(push_constant, scalar) uniform Push { int view; float base_alpha; float alpha_cutoff; } push;
layout(location = 0) in float in_depth;
#ifdef GN_MASKED
layout(binding = 2) uniform sampler2D base_color_texture;
layout(location = 1) in vec2 in_uv;
#endif
)";

constexpr const char* fragment_main = R"(
void main() {
#ifdef GN_MASKED
    if (textureLod(base_color_texture, in_uv, 0.0).a * push.base_alpha < push.alpha_cutoff) {
        discard;
    }
#endif
    float depth = clamp(in_depth, 0.0, 1.0);
#ifdef GN_WRITE_DEPTH
    gl_FragDepth = depth;
#endif
)";

struct Push {
    int view;
    float base_alpha, alpha_cutoff;
};

struct Variant {
    bool masked = false, write_depth = false;
};

/// The pipeline that draws casters: a fragment stage only where depth is not affine, alpha is tested or the map asks.
RasterDesc caster_pipeline(const CasterPass& pass, const Recipe& recipe, Variant variant) {
    const bool needs_fragment = variant.masked || variant.write_depth || !pass.fragment.body.empty();
    std::string defines;
    defines += needs_fragment ? "#define GN_FRAGMENT\n" : "";
    defines += variant.masked ? "#define GN_MASKED\n" : "";
    defines += variant.write_depth ? "#define GN_WRITE_DEPTH\n" : "";

    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, pass.name + ".vert", defines + vertex_text};
    if (needs_fragment) {
        desc.fragment = ShaderSource{
            ShaderKind::fragment, pass.name + ".frag",
            defines + pass.fragment.includes + fragment_head + fragment_main + pass.fragment.body + "\n}\n"};
    }
    desc.cull = recipe.casters == "front"  ? VK_CULL_MODE_BACK_BIT
                : recipe.casters == "back" ? VK_CULL_MODE_FRONT_BIT
                                           : VK_CULL_MODE_NONE;
    desc.depth_test = desc.depth_write = desc.depth_clamp = true;
    desc.depth_compare = VK_COMPARE_OP_LESS;
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
    desc.vertex_stride = sizeof(vec3);
    return desc;
}

void set_viewport(Recorder& r, const GnLightView& view) {
    const float n = view.resolution;
    r.viewport(view.rect_ts.x * n, view.rect_ts.y * n, view.rect_ts.z * n, view.rect_ts.w * n);
    r.scissor(static_cast<std::int32_t>(view.rect_ts.x * n), static_cast<std::int32_t>(view.rect_ts.y * n),
              static_cast<std::uint32_t>(view.rect_ts.z * n), static_cast<std::uint32_t>(view.rect_ts.w * n));
}

struct CasterDraw {
    CasterPass pass;
    Recipe recipe;
    LightViews views;
    SceneHandles handles;
    const Scene* scene = nullptr;
    std::size_t view = 0;

    [[nodiscard]] std::span<const std::uint32_t> objects() const {
        return views.casters.empty() ? std::span<const std::uint32_t>{}
                                     : std::span<const std::uint32_t>(views.casters[view]);
    }
    [[nodiscard]] bool nothing_to_draw() const { return !views.casters.empty() && views.casters[view].empty(); }

    void begin(Recorder& r, bool masked) const {
        r.bind(caster_pipeline(pass, recipe, {masked, views.views[view].affine_depth == 0}));
        set_views(r, views);
        if (pass.bind_values) {
            pass.bind_values(r);
        }
        r.vertex_buffer(handles.positions);
        r.index_buffer(handles.indices);
    }

    void opaque(Recorder& r) const {
        const std::vector<DrawRange> runs = opaque_runs(*scene, objects());
        if (runs.empty()) {
            return;
        }
        begin(r, false);
        r.push_value(Push{static_cast<int>(view), 1.0F, 0.0F});
        for (const DrawRange& run : runs) {
            r.draw_indexed(run.index_count, 1, run.first_index);
        }
    }

    void masked(Recorder& r) const {
        const std::vector<std::uint32_t> masked = masked_objects(*scene, objects());
        if (masked.empty()) {
            return;
        }
        begin(r, true);
        r.set("Uvs", handles.uvs);
        for (const std::uint32_t index : masked) {
            const Object& object = scene->objects[index];
            const Material& material = scene->materials[static_cast<std::size_t>(object.material)];
            const BaseColor color = base_color(*scene, handles, material);
            const AlphaTest test = alpha_test(material);
            r.set("base_color_texture", color.texture, color.sampler);
            r.push_value(Push{static_cast<int>(view), test.base_alpha, test.cutoff});
            r.draw_indexed(object.triangle_count * 3, 1, object.first_triangle * 3);
        }
    }
};

}  // namespace

void add_caster_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass) {
    std::vector<bool> cleared(views.layers, false);
    for (std::size_t view = 0; view < views.views.size(); ++view) {
        const auto layer = static_cast<std::uint32_t>(views.views[view].layer);
        const Load load = cleared[layer] ? Load::keep : Load::clear;
        cleared[layer] = true;
        const CasterDraw draw{pass, recipe, views, input.handles, &input.scene, view};
        input.graph.add_pass(
            pass.name,
            [&](PassBuilder& builder) {
                if (pass.color.valid()) {
                    builder.color(pass.color, load, pass.clear_color, one_layer(layer));
                }
                builder.depth(pass.depth, load, {.depth = 1.0F}, one_layer(layer));
                builder.vertices(input.handles.positions);
                builder.indices(input.handles.indices);
                builder.storage_read(input.handles.uvs);
                sample_textures(builder, input.handles);
                declare_views(builder, views);
            },
            [draw](Recorder& r) {
                if (draw.nothing_to_draw()) {
                    return;
                }
                set_viewport(r, draw.views.views[draw.view]);
                draw.opaque(r);
                draw.masked(r);
            });
    }
}

}  // namespace gn
