// SPDX-License-Identifier: MIT
#include "shadow/recipe/recipe_keys.h"

#include <algorithm>
#include <array>

namespace gn {
namespace {

/// Keys that belong to maps; without one a direct part reads those that it names in Part::reads.
constexpr std::array<std::string_view, 4> map_keys{"placement", "resolution", "casters", "bias"};

bool reads(const Recipe& recipe, std::string_view map_key) {
    return recipe.map != nullptr || (recipe.direct != nullptr && holds(recipe.direct->reads, map_key));
}

/// The placements that the recipe's lights may get: the named one, and those of lights that it does not serve.
std::vector<const Part*> placements_of(const Recipe& recipe) {
    std::vector<const Part*> parts;
    if (!reads(recipe, "placement")) {
        return parts;
    }
    for (uint kind = GN_LIGHT_DIRECTIONAL; kind <= GN_LIGHT_RECTANGLE; ++kind) {
        GnLight light;
        light.kind = kind;
        const Part* part = &recipe.placement_for(light);
        if (std::find(parts.begin(), parts.end(), part) == parts.end()) {
            parts.push_back(part);
        }
    }
    return parts;
}

std::vector<const Part*> parts_of(const Recipe& recipe) {
    std::vector<const Part*> parts = placements_of(recipe);
    for (const Part* part : recipe.parts()) {
        if (part->stage != Stage::placement) {
            parts.push_back(part);
        }
    }
    return parts;
}

bool is_map_key(std::string_view key) {
    return std::find(map_keys.begin(), map_keys.end(), key) != map_keys.end();
}

bool usable(const Recipe& recipe, std::span<const Part* const> parts, const RecipeKey& key) {
    const std::string& first = key.group.empty() ? key.name : key.group;
    if (key.group == "translucent") {
        return recipe.map != nullptr;
    }
    if (is_map_key(first)) {
        return reads(recipe, first);
    }
    // What names a stage's part is always read; a part's parameters are where the part takes part.
    return key.group.empty() || std::any_of(parts.begin(), parts.end(), [&](const Part* part) {
               return identifier(part->id) == identifier(key.group);
           });
}

std::string names_of(std::span<const Part* const> parts) {
    std::string names;
    for (const Part* part : parts) {
        names += fmt::format("{}{} '{}'", names.empty() ? "" : ", ", stage_names[static_cast<std::size_t>(part->stage)],
                             part->id);
    }
    return names.empty() ? "none" : names;
}

std::string keys_of(const Recipe& recipe, std::span<const Part* const> parts) {
    std::string names = "light, map, lookup, direct, visibility";
    for (const std::string_view key : map_keys) {
        names += reads(recipe, key) ? fmt::format(", {}{}", key, key == "bias" ? ".*" : "") : "";
    }
    for (const Part* part : parts) {
        names += part->params.rows.empty() ? "" : fmt::format(", {}.*", part->id);
    }
    return names;
}

}  // namespace

void check_keys(const Recipe& recipe, std::span<const RecipeKey> keys, const std::string& where) {
    const std::vector<const Part*> parts = parts_of(recipe);
    std::string unused;
    for (const RecipeKey& key : keys) {
        if (!usable(recipe, parts, key)) {
            unused += (unused.empty() ? "" : ", ") + key.text();
        }
    }
    if (!unused.empty()) {
        fail("{}: {} would change nothing: the recipe's parts are {}; keys that they read: {}", where, unused,
             names_of(parts), keys_of(recipe, parts));
    }
}

}  // namespace gn
