// SPDX-License-Identifier: MIT
// Views that a renderer fills with draws of its own.
#include "shadow/casters/drawn.h"

#include "shadow/casters/caster_draw.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {

void ask_drawn(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass) {
    const auto refused = [](const std::string& why) {
        refuse("{}, which a renderer that draws its casters itself cannot; lend their buffers", why);
    };
    if (views.buffer.valid() || views.tiles) {
        refused(fmt::format("placement '{}' makes its views on the device and draws into them there", views.part->id));
    }
    if (views.kind != ViewKind::affine && views.kind != ViewKind::perspective) {
        refused(fmt::format("placement '{}' draws curved triangles", views.part->id));
    }
    if (recipe.casters == Casters::midpoint || recipe.casters == Casters::dual || recipe.casters == Casters::ids) {
        refused(fmt::format("casters = {} tells surfaces and objects apart", name_of(recipe.casters)));
    }
    if (pass.every_side || input.translucent) {
        refused(fmt::format("pass '{}' peels surfaces or draws translucent ones", pass.name));
    }
    const std::string_view map = recipe.map != nullptr ? recipe.map->id : std::string_view(pass.name);
    if (pass.fragment.reads_slope) {
        refused(fmt::format("map '{}' stores slopes of triangles ({}.slope_moment=0 stores none)", map, map));
    }
    if (input.graph.desc(pass.depth).samples > 1) {
        refused(fmt::format("map '{}' draws several samples a texel", map));
    }
    CasterFormats& formats = input.handles.drawn->formats;
    formats.depth = input.graph.desc(pass.depth).format;
    formats.culled = recipe.casters == Casters::front  ? VK_CULL_MODE_BACK_BIT
                     : recipe.casters == Casters::back ? VK_CULL_MODE_FRONT_BIT
                                                       : VK_CULL_MODE_NONE;
    formats.affine = formats.affine || views.kind == ViewKind::affine;
    formats.bent = formats.bent || views.kind == ViewKind::perspective;
}

namespace {

ShaderInputs inputs_of(const LightViews& views, const CasterPass& pass) {
    ShaderInputs inputs = view_list(views);
    inputs.texture("sampler2DArray", "drawn_depth", pass.depth).add(pass.fragment.inputs);
    return inputs;
}

/// A map's fragments, of depths that were drawn; where nothing was, of the far plane.
RasterDesc from_depth(const CasterPass& pass, const ShaderInputs& inputs) {
    const std::string head = R"(
layout(push_constant, scalar) uniform Push { int view; } push;
#define caster_view push.view
)";
    const std::string main = R"(
void main() {
    float depth = texelFetch(drawn_depth, ivec3(gl_FragCoord.xy, views[caster_view].layer), 0).r;
)";
    return sealed(fullscreen({ShaderKind::fragment, pass.name + " from depth",
                              include_line("shadow/light_view.h") + pass.fragment.includes + inputs.text() + head +
                                  main + pass.fragment.body + "\n}\n"}));
}

/// All that its text depends on.
std::uint64_t key_of(const CasterPass& pass) {
    Hasher hasher;
    hasher.text(pass.name).text(pass.fragment.includes).text(pass.fragment.body);
    pass.fragment.inputs.hash(hasher);
    return hasher.finish().low;
}

}  // namespace

void add_drawn_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass) {
    LightViews one_by_one = views;
    one_by_one.layered = false;
    CasterPass depth = pass;
    depth.color = {};
    depth.fragment = {};
    add_caster_passes(input, recipe, one_by_one, depth);
    if (!pass.color.valid()) {
        return;
    }
    const ShaderInputs inputs = inputs_of(one_by_one, pass);
    const auto shader =
        made_once(input.prepared, "map from depth", key_of(pass), [&] { return from_depth(pass, inputs); });
    for (const ViewPass& view : view_passes(one_by_one)) {
        input.graph.add_pass(
            pass.name + " from depth",
            [&](PassBuilder& builder) {
                builder.color(pass.color, view.first_of_layer ? Load::clear : Load::keep, pass.clear_color,
                              one_layer(view.layer));
                inputs.declare(builder);
            },
            [=, of = one_by_one.views[view.index]](Recorder& r) {
                set_viewport(r, of);
                r.bind(*shader);
                inputs.set(r);
                r.push_value(static_cast<std::int32_t>(view.index));
                r.draw(3);
            });
    }
}

void CasterDraw::drawn(Recorder& r) const {
    if (r.vk() == VK_NULL_HANDLE) {
        return;  // there are no pipelines of ours to make
    }
    job->handles.drawn->draw({.commands = r.vk(),
                              .light_id = job->light_id,
                              .view = job->views.views[view],
                              .writes_depth = job->views.kind != ViewKind::affine});
    r.forget();
}

}  // namespace gn
