// SPDX-License-Identifier: MIT
#include "shadow/recipe/part.h"

#include "shadow/recipe/recipe.h"

#include <algorithm>

namespace gn {

bool LightKinds::has(uint kind) const {
    switch (kind) {
        case GN_LIGHT_DIRECTIONAL: return directional;
        case GN_LIGHT_SPOT: return spot;
        case GN_LIGHT_POINT: return point;
        case GN_LIGHT_RECTANGLE: return rectangle;
        case GN_LIGHT_ENVIRONMENT: return environment;
        default: return false;
    }
}

std::string LightKinds::names() const {
    std::string list;
    for (uint kind = 0; kind < light_kind_names.size(); ++kind) {
        if (has(kind)) {
            list += list.empty() ? "" : ", ";
            list += light_kind_names.at(kind);
        }
    }
    return list.empty() ? "no" : list;
}

bool tells(const Part& lookup, std::string_view side) {
    return std::any_of(lookup.sides.begin(), lookup.sides.end(), [&](const Side& told) { return told.name == side; });
}

std::string lookups_that_tell(std::string_view side) {
    std::string list;
    for (const Part* part : all_parts()) {
        if (part->stage == Stage::lookup && tells(*part, side)) {
            list += list.empty() ? "" : ", ";
            list += part->id;
        }
    }
    return list.empty() ? "none" : list;
}

namespace {

std::vector<std::string_view> with_filterable(bool filterable, const std::vector<std::string_view>& names) {
    std::vector<std::string_view> words;
    if (filterable) {
        words.emplace_back("filterable");
    }
    words.insert(words.end(), names.begin(), names.end());
    return words;
}

}  // namespace

std::vector<std::string_view> words_read(const Part& lookup) {
    return with_filterable(lookup.filters, lookup.needs);
}

std::vector<std::string_view> needs_of(const Recipe& recipe) {
    const Part& lookup = *recipe.lookup;
    return lookup.needs_for != nullptr ? lookup.needs_for(recipe) : lookup.needs;
}

std::vector<std::string_view> words_given(const Part& map) {
    return with_filterable(map.filterable, map.gives);
}

bool holds(std::span<const std::string_view> names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string identifier(std::string_view id) {
    std::string name(id);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

const Part& find_part(Stage stage, std::string_view id) {
    std::vector<std::string_view> known;
    for (const Part* part : all_parts()) {
        if (part->stage != stage) {
            continue;
        }
        if (identifier(part->id) == identifier(id)) {
            return *part;
        }
        known.push_back(part->id);
    }
    fail("unknown {} '{}'; {}", stage_names[static_cast<std::size_t>(stage)], id, suggest(id, known));
}

}  // namespace gn
