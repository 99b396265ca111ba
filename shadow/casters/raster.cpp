// SPDX-License-Identifier: MIT
#include "shadow/casters/raster.h"

#include "shadow/casters/caster_pipeline.h"
#include "shadow/casters/tiles.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/scene/casting.h"
#include "shadow/view/draw.h"

#include <algorithm>

namespace gn {

std::vector<ViewPass> view_passes(const LightViews& views) {
    std::vector<ViewPass> passes;
    if (views.tiles) {
        for (std::uint32_t layer = 0; layer < views.layers; ++layer) {
            passes.push_back({layer, layer, true});
        }
        return passes;
    }
    std::vector<bool> begun(views.layers, false);
    for (std::size_t i = 0; i < (views.layered ? 1 : views.views.size()); ++i) {
        const auto layer = static_cast<std::uint32_t>(views.views[i].layer);
        passes.push_back({i, layer, !begun[layer]});
        begun[layer] = true;
    }
    return passes;
}

void set_viewport(Recorder& r, const GnLightView& view) {
    const float n = view.resolution;
    r.viewport(view.rect_ts.x * n, view.rect_ts.y * n, view.rect_ts.z * n, view.rect_ts.w * n);
    r.scissor(static_cast<std::int32_t>(view.rect_ts.x * n), static_cast<std::int32_t>(view.rect_ts.y * n),
              static_cast<std::uint32_t>(view.rect_ts.z * n), static_cast<std::uint32_t>(view.rect_ts.w * n));
}

void CasterDraw::begin(Recorder& r, const CasterFaces& faces, bool masked) const {
    r.bind(caster_pipeline(pass, {masked, views.kind, views.layered && !views.tiles, views.tiles, faces}));
    r.depth_bias(push_units, push_pixels);
    view_inputs.set(r);
    pass.fragment.inputs.set(r);
    r.vertex_buffer(handles.positions);
    r.index_buffer(handles.indices);
}

void CasterDraw::opaque(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const {
    if (pass.by_object || views.tiles) {
        opaque_one_by_one(r, faces, objects);
        return;
    }
    const std::vector<DrawRange> runs = opaque_runs(*scene, objects);
    if (runs.empty()) {
        return;
    }
    begin(r, faces, false);
    r.push_value(CasterPush{static_cast<int>(view), 1.0F, 0.0F, -1});
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
            r.push_value(CasterPush{static_cast<int>(view), 1.0F, 0.0F, static_cast<int>(index)});
            draw_object(r, index);
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
        r.push_value(CasterPush{static_cast<int>(view), test.base_alpha, test.cutoff, static_cast<int>(index)});
        draw_object(r, index);
    }
}

void CasterDraw::draw_object(Recorder& r, std::uint32_t index) const {
    if (views.tiles) {
        r.draw_indexed_indirect(tile_draws, index * sizeof(VkDrawIndexedIndirectCommand));
        return;
    }
    const Object& object = scene->objects[index];
    r.draw_indexed(object.triangle_count * 3, instances(), object.first_triangle * 3);
}

std::vector<std::uint32_t> CasterDraw::objects() const {
    if (views.casters.empty()) {
        return casters(*scene, *light);
    }
    // One pass for all views draws what any of them needs.
    const bool all = views.layered || views.tiles;
    std::vector<std::uint32_t> found;
    for (std::size_t i = all ? 0 : view; i <= (all ? views.casters.size() - 1 : view); ++i) {
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
    view_inputs.declare(builder);
    if (views.tiles) {
        builder.indirect(tile_draws);
    }
    pass.fragment.inputs.declare(builder);
}

void add_caster_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass) {
    if (can_keep(input, views, pass)) {
        add_kept_passes(input, recipe, views, pass);
        return;
    }
    const BufferHandle tile_draws = views.tiles ? add_tile_draws(input, views) : BufferHandle{};
    for (const ViewPass& view : view_passes(views)) {
        const Load load = view.first_of_layer ? Load::clear : Load::keep;
        const Range range = views.layered && !views.tiles ? Range{0, 1, 0, views.layers} : one_layer(view.layer);
        const CasterDraw draw{pass,           recipe,     views,      input.handles,     &input.scene,
                              &input.light(), view.index, tile_draws, view_inputs(views)};
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
                if (!draw.views.tiles) {
                    set_viewport(r, draw.views.views[draw.view]);
                }
                draw.record(r);
            });
    }
}

}  // namespace gn
