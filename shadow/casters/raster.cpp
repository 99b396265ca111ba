// SPDX-License-Identifier: MIT
#include "shadow/casters/raster.h"

#include "shadow/casters/caster_pipeline.h"
#include "shadow/casters/pages.h"
#include "shadow/casters/tiles.h"
#include "shadow/geometry/draw.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/casting.h"

#include <algorithm>
#include <cmath>

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

namespace {

std::uint64_t key_of(const CasterJob& job, const CasterVariant& variant) {
    return Hasher()
        .value(job.shader_key)
        .value(variant.masked)
        .value(variant.kind)
        .value(variant.layered)
        .value(variant.tiles)
        .value(variant.faces.culled)
        .value(variant.faces.pushed)
        .value(variant.faces.depth_only)
        .finish()
        .low;
}

}  // namespace

void set_viewport(Recorder& r, const GnLightView& view) {
    // Whole texels are whole whatever a quotient's rounding makes of them.
    vec4 texels = view.rect_ts * view.resolution;
    for (int i = 0; i < 4; ++i) {
        texels[i] = std::abs(texels[i] - std::round(texels[i])) < 1e-3F ? std::round(texels[i]) : texels[i];
    }
    r.viewport(texels.x, texels.y, texels.z, texels.w);
    r.scissor(static_cast<std::int32_t>(texels.x), static_cast<std::int32_t>(texels.y),
              static_cast<std::uint32_t>(texels.z), static_cast<std::uint32_t>(texels.w));
}

void CasterDraw::begin(Recorder& r, const CasterFaces& faces, bool masked) const {
    const LightViews& views = job->views;
    const CasterVariant variant{masked, views.kind, views.layered && !views.tiles, views.tiles, faces};
    r.bind(*made_once(job->prepared, "caster pipeline", key_of(*job, variant),
                      [&] { return sealed(caster_pipeline(job->pass, variant)); }));
    r.depth_bias(push_units, push_pixels);
    job->inputs.set(r);
    r.vertex_buffer(job->handles.positions);
    r.index_buffer(job->handles.indices);
}

void CasterDraw::opaque(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const {
    if (job->pass.by_object || job->translucent || job->views.tiles) {
        opaque_one_by_one(r, faces, objects);
        return;
    }
    ranges(r, faces, opaque_runs(*job->scene, objects));
}

void CasterDraw::ranges(Recorder& r, const CasterFaces& faces, std::span<const DrawRange> ranges) const {
    std::vector<VkDrawIndexedIndirectCommand> draws;
    for (const DrawRange& run : ranges) {
        draws.push_back({run.index_count, instances(), run.first_index, 0, 0});
    }
    if (draws.empty()) {
        return;
    }
    begin(r, faces, false);
    r.push_value(CasterPush{static_cast<int>(view), 1.0F, 0.0F, -1, 0});
    r.draw_indexed(draws);
}

void CasterDraw::opaque_one_by_one(Recorder& r, const CasterFaces& faces,
                                   std::span<const std::uint32_t> objects) const {
    if (objects.empty()) {
        return;
    }
    begin(r, faces, false);
    for (const std::uint32_t index : objects) {
        const Object& object = job->scene->objects[index];
        if (job->translucent || !is_masked(*job->scene, object)) {
            r.push_value(CasterPush{static_cast<int>(view), 1.0F, 0.0F, static_cast<int>(index), tile_draw(index)});
            draw_object(r, index);
        }
    }
}

void CasterDraw::masked(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const {
    const std::vector<std::uint32_t> masked = masked_objects(*job->scene, objects);
    if (masked.empty() || job->translucent) {
        return;
    }
    begin(r, faces, true);
    for (const std::uint32_t index : masked) {
        const Object& object = job->scene->objects[index];
        const Material& material = job->scene->materials[static_cast<std::size_t>(object.material)];
        const BaseColor color = base_color(*job->scene, job->handles, material);
        const AlphaTest test = alpha_test(material);
        r.set("base_color_texture", color.texture, color.sampler);
        r.push_value(CasterPush{static_cast<int>(view), test.base_alpha, test.cutoff, static_cast<int>(index),
                                tile_draw(index)});
        draw_object(r, index);
    }
}

int CasterDraw::tile_draw(std::uint32_t object) const {
    return job->views.tiles ? static_cast<int>(view * job->scene->objects.size() + object) : 0;
}

void CasterDraw::draw_object(Recorder& r, std::uint32_t index) const {
    if (job->views.tiles) {
        r.draw_indexed_indirect(job->tile_lists.draws,
                                static_cast<VkDeviceSize>(tile_draw(index)) * sizeof(VkDrawIndexedIndirectCommand));
        return;
    }
    const Object& object = job->scene->objects[index];
    r.draw_indexed(object.triangle_count * 3, instances(), object.first_triangle * 3);
}

std::vector<std::uint32_t> CasterDraw::objects() const {
    if (job->translucent) {
        return translucent_casters(*job->scene, *job->light);
    }
    if (job->views.casters.empty()) {
        return casters(*job->scene, *job->light);
    }
    // One pass for all views draws what any of them needs.
    const bool all = job->views.layered || job->views.tiles;
    std::vector<std::uint32_t> found;
    for (std::size_t i = all ? 0 : view; i <= (all ? job->views.casters.size() - 1 : view); ++i) {
        found.insert(found.end(), job->views.casters[i].begin(), job->views.casters[i].end());
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::erase_if(found, [&](std::uint32_t object) { return !casts(*job->scene, object, job->light); });
    return found;
}

void CasterDraw::draw(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const {
    opaque(r, faces, objects);
    masked(r, faces, objects);
}

namespace {
constexpr CasterFaces fronts{.culled = VK_CULL_MODE_BACK_BIT};
constexpr CasterFaces backs{.culled = VK_CULL_MODE_FRONT_BIT};
}  // namespace

void CasterDraw::both_sided(Recorder& r, std::span<const std::uint32_t> objects) const {
    if (job->solids == nullptr) {
        draw(r, {}, objects);
        return;
    }
    const SolidFaces faces = solid_faces(*job->scene, *job->solids, objects, job->light->shape);
    ranges(r, {}, faces.both);
    ranges(r, fronts, faces.front);
    ranges(r, backs, faces.back);
    masked(r, {}, objects);
}

void CasterDraw::record(Recorder& r) const {
    if (job->handles.drawn != nullptr) {
        drawn(r);
        return;
    }
    const std::vector<std::uint32_t> drawn = draw_simpler(r, objects());
    if (job->kept == Casters::front || job->kept == Casters::back) {
        draw(r, job->kept == Casters::front ? fronts : backs, drawn);
        return;
    }

    // A material with one side casts from that side only.
    std::vector<std::uint32_t> both;
    std::vector<std::uint32_t> one;
    for (const std::uint32_t object : drawn) {
        (is_single_sided(*job->scene, job->scene->objects[object]) && !job->pass.every_side ? one : both)
            .push_back(object);
    }
    if (!job->pass.by_object) {
        both_sided(r, both);
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
    if (job->handles.drawn != nullptr) {
        return;
    }
    builder.vertices(job->handles.positions);
    builder.indices(job->handles.indices);
    if (job->simpler != nullptr) {
        builder.indices(job->simpler_indices);
    }
    for (const TextureHandle mask : job->masks) {
        builder.sample(mask);
    }
    job->inputs.declare(builder);
    if (job->views.tiles) {
        builder.indirect(job->tile_lists.draws);
    }
}

namespace {

/// The base colour textures of alpha-tested materials, by their index; -1 is white.
std::vector<int> masks_of(const Scene& scene) {
    std::vector<int> masks;
    for (const Material& material : scene.materials) {
        if (material.alpha_mode != AlphaMode::opaque) {
            masks.push_back(material.base_color_texture);
        }
    }
    std::sort(masks.begin(), masks.end());
    masks.erase(std::unique(masks.begin(), masks.end()), masks.end());
    return masks;
}

/// What views ask for of simpler casters: behind them stand those that see these farther away.
std::shared_ptr<const SimplerCasters> simpler_for(const FrameInput& input, const CasterPass& pass, LightViews& views) {
    if (views.simpler.empty() || input.translucent || pass.by_object) {
        return nullptr;
    }
    GN_CHECK(views.kind == ViewKind::affine && !views.layered && !views.tiles && !views.buffer.valid());
    std::shared_ptr<const SimplerCasters> simpler = simpler_casters(input, views.simpler);
    for (std::size_t i = 0; simpler != nullptr && i < views.simpler.size(); ++i) {
        views.views.push_back(set_back(views.views[i], views.simpler[i]));
    }
    return simpler;
}

/// Says what was saved.
void tell_simpler(const FrameInput& input, const SimplerCasters& simpler) {
    if (input.late_remarks != nullptr) {
        input.late_remarks->insert(fmt::format(
            "into the farthest map of light '{}' {} objects cast as simpler meshes within {:.2g} m of them, of "
            "{} triangles instead of {}",
            input.light().name, simpler.objects, simpler.errors.back(), simpler.triangles_after,
            simpler.triangles_before));
    }
}

}  // namespace

std::shared_ptr<const CasterJob> caster_job(const FrameInput& input, const Recipe& recipe, LightViews views,
                                            const CasterPass& pass) {
    const std::shared_ptr<const SimplerCasters> simpler = simpler_for(input, pass, views);
    const TileLists tile_lists = views.tiles ? add_tile_lists(input, views) : TileLists{};
    const std::vector<int> masks = masks_of(input.scene);
    ShaderInputs inputs = caster_inputs(views, input.handles, !masks.empty(), views.tiles, tile_lists.views);
    inputs.add(pass.fragment.inputs);
    auto job =
        std::make_shared<CasterJob>(CasterJob{pass, recipe.casters, std::move(views), input.handles, &input.scene,
                                              &input.light(), input.prepared, std::move(inputs), tile_lists});
    for (const int mask : masks) {
        job->masks.push_back(mask < 0 ? input.handles.white : input.handles.textures[static_cast<std::size_t>(mask)]);
    }
    Hasher hasher;
    hasher.text(pass.name).text(pass.fragment.includes).text(pass.fragment.body);
    pass.fragment.inputs.hash(hasher);
    job->shader_key = hasher.finish().low;
    job->translucent = input.translucent;
    job->light_id = input.light_id;
    if (simpler != nullptr) {
        job->simpler = simpler;
        job->simpler_indices = input.graph.import(simpler->indices);
        tell_simpler(input, *simpler);
    }
    if (recipe.casters == Casters::automatic && !input.translucent && !job->views.tiles) {
        job->solids = solids_of(input);
    }
    return job;
}

void add_caster_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass) {
    if (input.handles.drawn != nullptr) {
        ask_drawn(input, recipe, views, pass);
        if (views.layered || pass.color.valid()) {
            add_drawn_passes(input, recipe, views, pass);
            return;
        }
    }
    if (are_pages(views)) {
        add_page_passes(input, recipe, views, pass);
        return;
    }
    if (!input.translucent && can_keep(input, views, pass)) {
        add_kept_passes(input, recipe, views, pass);
        return;
    }
    const std::shared_ptr<const CasterJob> job = caster_job(input, recipe, views, pass);
    for (const ViewPass& view : view_passes(views)) {
        const Load load = view.first_of_layer ? Load::clear : Load::keep;
        const Range range = views.layered && !views.tiles ? Range{0, 1, 0, views.layers} : one_layer(view.layer);
        const CasterDraw draw{job, view.index};
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
                if (!draw.job->views.tiles) {
                    set_viewport(r, draw.job->views.views[draw.view]);
                }
                draw.record(r);
            });
    }
}

}  // namespace gn
