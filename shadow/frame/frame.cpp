// SPDX-License-Identifier: MIT
// The frame as a table of contents: one call a stage, in flow order.
#include "shadow/frame/frame.h"

#include "shadow/casters/kept_map.h"
#include "shadow/frame/map_memory.h"
#include "shadow/frame/seen_by.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/light/weighted.h"
#include "shadow/map/derived.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/reprojection.h"
#include "shadow/recipe/check_recipe.h"
#include "shadow/scene/casting.h"
#include "shadow/view/read_back.h"
#include "shadow/visibility/combine.h"

namespace gn {

FrameInput seen_by(const FrameInput& input, const ViewSamples& samples) {
    FrameInput other{input.device, input.graph, input.scene, input.handles, samples};
    other.source = input.source;
    other.light_id = input.light_id;
    other.history = input.history;
    other.late_remarks = input.late_remarks;
    other.prepared = input.prepared;
    other.parent = input.parent;
    other.sides = input.sides;
    other.translucent = input.translucent;
    other.reach = input.reach;
    return other;
}

namespace {

/// The map and what is made of it.
ShadowMap add_map(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    ShadowMap map = recipe.map->add_map(input, recipe, views);
    map.part = recipe.map;
    add_derived(input, recipe, views, map);
    check_map_memory(input, recipe, map.texture());
    return map;
}

/// placement -> map -> lookup.
Visibility add_mapped(const FrameInput& input, const Recipe& recipe) {
    const LightViews views = place_views(input, recipe);
    const ShadowMap map = add_kept_map(input, recipe, views, [&] { return add_map(input, recipe, views); });
    const FrameInput looked = input.few != nullptr ? seen_by(input, *input.few) : input;
    return recipe.lookup->add_lookup != nullptr ? recipe.lookup->add_lookup(looked, recipe, views, map)
                                                : add_resolve(looked, recipe, views, map);
}

/// The same for opaque casters and, where there are any, for translucent ones: the product.
Visibility add_both_maps(const FrameInput& input, const Recipe& recipe) {
    Visibility solid = add_mapped(input, recipe);
    if (recipe.translucent_map == nullptr || translucent_casters(input.scene, input.light()).empty()) {
        return solid;
    }
    FrameInput glass = input;
    glass.translucent = true;
    glass.sides.clear();
    return add_combined(input, solid, add_mapped(glass, recipe.of_translucent()), Combine::product);
}

/// What the visibility parts ask the lookup to tell.
std::vector<std::string_view> needed_sides(const Recipe& recipe) {
    std::vector<std::string_view> sides;
    for (const Part* part : recipe.visibility) {
        for (const std::string_view need : part->needs) {
            if (!holds(sides, need)) {
                sides.push_back(need);
            }
        }
    }
    return sides;
}

/// Map, direct part, or both as one.
Visibility add_one_light(const FrameInput& input, const Recipe& recipe) {
    if (recipe.lookup == nullptr && recipe.direct == nullptr) {
        return add_no_shadow(input);
    }
    if (recipe.direct == nullptr) {
        return add_both_maps(input, recipe);
    }
    const Visibility direct = recipe.direct->add_direct(input, recipe);
    return recipe.lookup == nullptr ? direct
                                    : add_combined(input, add_both_maps(input, recipe), direct, recipe.combine.value());
}

}  // namespace

Visibility add_shadow(const FrameInput& input, const Recipe& recipe) {
    check_recipe(recipe, input.scene, input.light(), input.device);

    FrameInput asking = remembering(input);
    const auto serve = [&](const FrameInput& light) { return add_one_light(light, recipe); };
    Visibility visibility;
    if (recipe.light != nullptr) {
        visibility = add_weighted(asking, recipe, serve);
    } else {
        asking.sides = needed_sides(recipe);
        visibility = serve(asking);
    }
    for (const Part* part : recipe.visibility) {
        // What the lookup told stays beside V.
        std::vector<Offer> sides = visibility.sides;
        visibility = part->add_visibility(input, recipe, visibility);
        visibility.sides = std::move(sides);
    }
    add_unshadowed(input, visibility);
    return visibility;
}

std::vector<LightShadow> add_frame(FrameGraph& graph, const ViewSamples& receivers, const FrameCasters& casters,
                                   std::span<const FrameLight> lights, const PreparedRecipe& recipe, History* history,
                                   std::set<std::string>* late_remarks) {
    const std::string outer = graph.group();
    graph.group("shadow");
    std::vector<LightShadow> shadows;
    if (history != nullptr) {
        leave_frame(*history, receivers, casters.scene, casters.handles);
    }
    for (const FrameLight& light : lights) {
        shadows.emplace_back();
        const FrameInput input{graph.device(), graph,    casters.scene, casters.handles, receivers,
                               light.light,    light.id, history,       late_remarks,    &recipe};
        try {
            shadows.back().visibility = add_shadow(input, recipe.recipe());
        } catch (const Refusal& refusal) {
            shadows.back().refused = refusal.what();
        }
    }
    graph.group(outer);
    return shadows;
}

std::vector<FrameLight> lights_of(const Scene& scene) {
    std::vector<FrameLight> lights;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        lights.push_back({&scene.lights[i], i});
    }
    return lights;
}

}  // namespace gn
