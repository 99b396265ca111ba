// SPDX-License-Identifier: MIT
#include "apps/view/recipe_text.h"

#include "shadow/recipe/check_recipe.h"
#include "shadow/recipe/recipe_set.h"

#include <algorithm>
#include <optional>

namespace gn {

RecipeText RecipeText::parse(std::string_view text) {
    RecipeText recipe;
    const std::size_t comma = std::min(text.find(','), text.size());
    recipe.base = std::string(text.substr(0, comma));
    text.remove_prefix(std::min(text.size(), comma + 1));
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(','), text.size());
        const std::string_view item = text.substr(0, end);
        text.remove_prefix(std::min(text.size(), end + 1));
        const std::size_t equals = std::min(item.find('='), item.size());
        recipe.set(item.substr(0, equals), std::string(item.substr(std::min(equals + 1, item.size()))));
    }
    return recipe;
}

std::string RecipeText::text() const {
    std::string text = base;
    for (const auto& [key, value] : overrides) {
        text += fmt::format(",{}={}", key, value);
    }
    return text;
}

void RecipeText::set(std::string_view key, std::string value) {
    const auto found = std::find_if(overrides.begin(), overrides.end(), [&](const auto& o) { return o.first == key; });
    if (found != overrides.end()) {
        found->second = std::move(value);
    } else {
        overrides.emplace_back(std::string(key), std::move(value));
    }
}

void RecipeText::drop(std::string_view key) {
    std::erase_if(overrides, [&](const auto& override) { return override.first == key; });
}

namespace {

std::string id_of(const Part* part, std::string_view none) {
    return std::string(part != nullptr ? part->id : none);
}

std::string joined_ids(std::span<const Part* const> parts) {
    std::string ids;
    for (const Part* part : parts) {
        ids += (ids.empty() ? "" : "+") + std::string(part->id);
    }
    return ids.empty() ? "none" : ids;
}

}  // namespace

std::string value_of(const Recipe& recipe, std::string_view key) {
    const std::size_t dot = key.find('.');
    if (dot != std::string_view::npos) {
        const std::string_view group = key.substr(0, dot), name = key.substr(dot + 1);
        const ParamTable bias = bias_table(recipe.bias);
        return group == "bias" ? ParamBlock(bias).get(name) : recipe.params.find(group)->second.get(name);
    }
    return key == "light"        ? id_of(recipe.light, "none")
           : key == "placement"  ? recipe.placement_name()
           : key == "map"        ? id_of(recipe.map, "none")
           : key == "lookup"     ? id_of(recipe.lookup, "none")
           : key == "direct"     ? id_of(recipe.direct, "none")
           : key == "visibility" ? joined_ids(recipe.visibility)
           : key == "casters"    ? std::string(name_of(recipe.casters))
           : key == "resolution" ? fmt::format("{}", recipe.resolution)
                                 : "";
}

ChangedRecipe change_recipe(const RecipeText& text, std::string_view key, const std::string& value) {
    ChangedRecipe changed{text, {}};
    changed.text.set(key, value);
    const auto load = [&]() -> std::string {
        try {
            changed.recipe = load_recipe(changed.text.text());
            return stages_misfit(changed.recipe);
        } catch (const Error& error) {
            return error.what();
        }
    };
    const std::string sentence = load();
    if (sentence.empty()) {
        return changed;
    }
    // What was set for parts that are gone is no mistake of whoever chose another part: leave it out, one key at a time, as
    // long as that helps.
    const bool part_changed = key.find('.') == std::string_view::npos;
    for (std::size_t i = 0; part_changed && i < text.overrides.size(); ++i) {
        const std::string& other = text.overrides[i].first;
        if (other != key && other.find('.') != std::string::npos) {
            changed.text.drop(other);
            if (load().empty()) {
                return changed;
            }
        }
    }
    throw Error(sentence);
}

std::vector<const Part*> serving_parts(const Recipe& recipe, std::span<const Light> lights) {
    std::vector<const Part*> parts = recipe.parts();
    for (const Light& light : lights) {
        const bool mapped = recipe.map != nullptr && light.shape.kind != GN_LIGHT_ENVIRONMENT;
        const Part* placement = mapped ? &recipe.placement_for(light.shape) : nullptr;
        if (placement != nullptr && std::find(parts.begin(), parts.end(), placement) == parts.end()) {
            parts.push_back(placement);
        }
    }
    return parts;
}

}  // namespace gn
