// SPDX-License-Identifier: MIT
// What a recipe cannot do, asked before anything is drawn.
#include "shadow/recipe/check_recipe.h"

#include "shadow/casters/caster_depth.h"

#include <algorithm>
#include <array>

namespace gn {
namespace {

/// Ids of a stage's parts for which `fits` holds, "depth, moments", or "none".
template <class Fits>
std::string ids_of(Stage stage, const Fits& fits) {
    std::string list;
    for (const Part* part : all_parts()) {
        if (part->stage == stage && fits(*part)) {
            list += list.empty() ? "" : ", ";
            list += part->id;
        }
    }
    return list.empty() ? "none" : list;
}

std::string joined(std::span<const std::string_view> names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

bool gives_all(const Part& map, const Part& lookup) {
    return (map.filterable || !lookup.filters) &&
           std::all_of(lookup.needs.begin(), lookup.needs.end(),
                       [&](std::string_view need) { return map_gives(map, need); });
}

std::string maps_for(const Part& lookup) {
    return ids_of(Stage::map, [&](const Part& part) { return gives_all(part, lookup); });
}

std::string lookups_for(const Part& map) {
    return ids_of(Stage::lookup, [&](const Part& part) { return gives_all(map, part); });
}

std::string mismatch_of(const Part& map, const Part& lookup) {
    if (gives_all(map, lookup)) {
        return {};
    }
    return fmt::format("lookup '{}' reads {} but map '{}' gives {}; maps that give {}: {}; lookups that read '{}': {}",
                       lookup.id, joined(words_read(lookup)), map.id, joined(words_given(map)),
                       joined(words_read(lookup)), maps_for(lookup), map.id, lookups_for(map));
}

/// The sentence why what the recipe keeps of its casters does not fit its parts or the scene, or "".
std::string casters_misfit(const Recipe& recipe, const Scene& scene) {
    const Casters casters = recipe.casters;
    if (casters == Casters::all || (recipe.direct == nullptr && recipe.map == nullptr)) {
        return {};
    }
    if (recipe.map == nullptr) {
        return fmt::format(
            "casters = {} says what a map part keeps, and a recipe with direct '{}' has none; valid is all",
            name_of(casters), recipe.direct->id);
    }
    const bool separated = casters == Casters::midpoint || casters == Casters::dual || casters == Casters::ids;
    if (separated && !recipe.map->separates_casters) {
        return fmt::format(
            "casters = {} is not kept by map '{}'; maps that keep it: {}; '{}' takes all, auto, front, back",
            name_of(casters), recipe.map->id,
            ids_of(Stage::map, [](const Part& part) { return part.separates_casters; }), recipe.map->id);
    }
    if (casters == Casters::ids && !holds(recipe.lookup->optional, "ids")) {
        return fmt::format("casters = ids: lookup '{}' compares depths only; lookups that compare ids: {}",
                           recipe.lookup->id,
                           ids_of(Stage::lookup, [](const Part& part) { return holds(part.optional, "ids"); }));
    }
    if (casters == Casters::ids && scene.objects.size() > max_object_ids) {
        return fmt::format("casters = ids: the scene has {} objects; at most {} have an id of their own",
                           scene.objects.size(), max_object_ids);
    }
    return {};
}

void check_part(const Part& part, const Recipe& recipe, const Scene& scene, const Light& light, const Device& device) {
    const std::string_view stage = stage_names[static_cast<std::size_t>(part.stage)];
    if (!part.lights.has(light.shape.kind)) {
        refuse("{} '{}' does not serve {} lights such as '{}'; it serves {} lights", stage, part.id,
               light_kind_names.at(light.shape.kind), light.name, part.lights.names());
    }
    std::vector<Feature> features = part.features;
    if (part.features_for != nullptr) {
        const std::vector<Feature> more = part.features_for(recipe);
        features.insert(features.end(), more.begin(), more.end());
    }
    for (const Feature feature : features) {
        if (!device.has(feature)) {
            refuse("{} '{}' needs the feature {}, which device '{}' lacks", stage, part.id, feature_name(feature),
                   device.info().name);
        }
    }
    if (part.refuses != nullptr) {
        if (const std::string sentence = part.refuses(scene, light, recipe); !sentence.empty()) {
            refuse("{}", sentence);
        }
    }
}

/// A placement is named for the lights that it serves.
bool serves_some(const Part& placement, const Scene& scene) {
    return std::any_of(scene.lights.begin(), scene.lights.end(),
                       [&](const Light& light) { return placement.lights.has(light.shape.kind); });
}

}  // namespace

void check_complete(const Recipe& recipe) {
    if (recipe.lookup != nullptr && recipe.map == nullptr) {
        fail("recipe {}: lookup '{}' reads a map and none is named; maps that give {}: {}", recipe.name,
             recipe.lookup->id, joined(words_read(*recipe.lookup)), maps_for(*recipe.lookup));
    }
    if (recipe.map != nullptr && recipe.lookup == nullptr) {
        fail("recipe {}: map '{}' is read by no lookup; lookups that read it: {}", recipe.name, recipe.map->id,
             lookups_for(*recipe.map));
    }
    if ((recipe.translucent_map == nullptr) != (recipe.translucent_lookup == nullptr)) {
        fail("recipe {}: translucent casters need a map and a lookup, and only translucent.{} is named", recipe.name,
             recipe.translucent_map != nullptr ? "map" : "lookup");
    }
    const Part* idle = recipe.light != nullptr      ? recipe.light
                       : !recipe.visibility.empty() ? recipe.visibility.front()
                                                    : nullptr;
    if (idle != nullptr && recipe.map == nullptr && recipe.direct == nullptr) {
        fail(
            "recipe {}: {} '{}' works on shadows and no part draws any; name a map and a lookup, or direct, of which "
            "there are {}",
            recipe.name, stage_names[static_cast<std::size_t>(idle->stage)], idle->id,
            ids_of(Stage::direct, [](const Part&) { return true; }));
    }
}

bool has_both(const Recipe& recipe) {
    return recipe.direct != nullptr && (recipe.map != nullptr || recipe.lookup != nullptr);
}

void check_combine(const Recipe& recipe, const std::string& where) {
    if (recipe.combine && !has_both(recipe)) {
        fail("{}: combine = {} has nothing to combine: the recipe names no {}; combine belongs where both stand", where,
             combine_names.at(static_cast<std::size_t>(*recipe.combine)),
             recipe.direct == nullptr ? "direct part" : "map beside its direct part");
    }
}

std::string stages_misfit(const Recipe& recipe) {
    return recipe.map != nullptr && recipe.lookup != nullptr ? mismatch_of(*recipe.map, *recipe.lookup) : "";
}

std::string placement_remark(const Recipe& recipe, const Scene& scene) {
    if (recipe.placement == nullptr || recipe.placement_or_auto || !serves_some(*recipe.placement, scene)) {
        return {};
    }
    std::string others;
    for (uint kind = 0; kind < light_kind_names.size(); ++kind) {
        const auto light = std::find_if(scene.lights.begin(), scene.lights.end(),
                                        [&](const Light& l) { return l.shape.kind == kind; });
        if (light != scene.lights.end() && !recipe.placement->lights.has(kind)) {
            others += fmt::format("{}{} lights by '{}'", others.empty() ? "" : ", ", light_kind_names.at(kind),
                                  recipe.placement_for(light->shape).id);
        }
    }
    return others.empty() ? ""
                          : fmt::format("placement '{}' serves {} lights; placed otherwise: {}", recipe.placement->id,
                                        recipe.placement->lights.names(), others);
}

void check_recipe(const Recipe& recipe, const Scene& scene, const Light& light, const Device& device) {
    // A placement that serves none of the lights was named in vain.
    if (recipe.placement != nullptr && !recipe.placement_or_auto && !serves_some(*recipe.placement, scene)) {
        check_part(*recipe.placement, recipe, scene, light, device);
    }

    // The stages must fit each other before anything is asked of one.
    if (has_both(recipe) && !recipe.combine) {
        refuse("direct '{}' stands beside map '{}' and nothing says how their V become one; combine is {}",
               recipe.direct->id, recipe.map->id, fmt::join(combine_names, " or "));
    }
    if (recipe.map != nullptr && recipe.lookup != nullptr) {
        if (const std::string sentence = stages_misfit(recipe); !sentence.empty()) {
            refuse("{}", sentence);
        }
        check_part(recipe.placement_for(light.shape), recipe, scene, light, device);
    }
    if (recipe.translucent_map != nullptr && recipe.translucent_map->solid_only) {
        refuse("translucent.map = {}: map '{}' holds opaque casters only; maps that hold translucent ones: {}",
               recipe.translucent_map->id, recipe.translucent_map->id,
               ids_of(Stage::map, [](const Part& part) { return !part.solid_only; }));
    }
    if (const std::string sentence =
            recipe.translucent_map != nullptr ? stages_misfit(recipe.of_translucent()) : std::string();
        !sentence.empty()) {
        refuse("{}", sentence);
    }
    for (const Part* part : recipe.visibility) {
        for (const std::string_view side : part->needs) {
            if (recipe.light != nullptr || recipe.lookup == nullptr || !tells(*recipe.lookup, side)) {
                refuse("visibility '{}' reads '{}', which {} does not tell; lookups that tell it: {}", part->id, side,
                       recipe.light != nullptr    ? fmt::format("light '{}' with its many lights", recipe.light->id)
                       : recipe.lookup != nullptr ? fmt::format("lookup '{}'", recipe.lookup->id)
                                                  : "a recipe without a lookup",
                       lookups_that_tell(side));
            }
        }
    }
    if (const std::string sentence = casters_misfit(recipe, scene); !sentence.empty()) {
        refuse("{}", sentence);
    }
    for (const Part* part : recipe.parts()) {
        // A placement is asked for the lights that it serves.
        if (part->stage != Stage::placement) {
            check_part(*part, recipe, scene, light, device);
        }
    }
}

}  // namespace gn
