// SPDX-License-Identifier: MIT
#include "shadow/recipe/recipe.h"

#include "base/paths.h"
#include "base/toml_scalar.h"
#include "shadow/recipe/check_recipe.h"
#include "shadow/recipe/recipe_keys.h"
#include "shadow/recipe/recipe_set.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gn {

namespace {

constexpr std::uintmax_t max_recipe_bytes = 1U << 20U;

/// A list of names is written "one+another" from here on, as overrides have it.
std::string text_of_list(const toml::array& list, std::string_view key, const std::string& where) {
    std::string text;
    for (const toml::node& node : list) {
        const auto* name = node.as_string();
        if (name == nullptr || name->get().empty()) {
            fail("{}: {} lists what is no part's name; it is one name or a list of names", where, key);
        }
        text += (text.empty() ? "" : "+") + name->get();
    }
    return text.empty() ? "none" : text;
}

std::string text_of(const toml::node& node, std::string_view key, const std::string& where) {
    if (const auto* list = node.as_array(); list != nullptr && (key == "visibility" || key == "placement")) {
        return text_of_list(*list, key, where);
    }
    if (std::optional<std::string> text = scalar_text(node)) {
        return *std::move(text);
    }
    fail("{}: {} is neither a number, a text nor true or false", where, key);
}

/// Remembers that a key was set. A placement left to the lights is none that was named.
void remember(std::vector<RecipeKey>& keys, std::string_view group, std::string_view name, const Recipe& recipe) {
    if (!group.empty() || name != "placement" || recipe.placement != nullptr) {
        keys.push_back({std::string(group), std::string(name)});
    }
}

void read_table(Recipe& recipe, const toml::table& file, const std::string& where) {
    std::vector<RecipeKey> keys;
    // Of a file that names both kinds of technique nobody knows how it means them.
    if (file.contains("direct") && (file.contains("map") || file.contains("lookup")) && !file.contains("combine")) {
        fail("{}: direct stands beside map or lookup and nothing says how their V become one; combine is {}", where,
             fmt::join(combine_names, " or "));
    }
    for (const auto& [toml_key, node] : file) {
        const std::string_view key = toml_key.str();
        if (const toml::table* group = node.as_table()) {
            for (const auto& [name, value] : *group) {
                const std::string full = fmt::format("{}.{}", key, name.str());
                set_group(recipe, key, name.str(), text_of(value, full, where), where);
                remember(keys, key, name.str(), recipe);
            }
        } else if (key == "title") {
            recipe.title = text_of(node, key, where);
        } else if (key == "paragraph") {
            recipe.paragraph = text_of(node, key, where);
        } else if (key == "citation") {
            recipe.citation = text_of(node, key, where);
        } else if (!set_top_level(recipe, key, text_of(node, key, where), where)) {
            fail_unknown_key(recipe, key, where);
        } else {
            remember(keys, "", key, recipe);
        }
    }
    check_combine(recipe, where);
    check_keys(recipe, keys, where);
}

bool is_path(std::string_view name) {
    return name.ends_with(".toml") || name.find('/') != std::string_view::npos;
}

std::filesystem::path recipes_of(const std::filesystem::path& data) {
    return (data.empty() ? data_root() : data) / "recipes";
}

toml::table read_file(const std::filesystem::path& path, const std::string& where) {
    // Open it once it is known to be a plain file: a pipe would never end. Read it once it is known to be small.
    std::error_code code;
    const bool plain = std::filesystem::is_regular_file(path, code);
    const std::uintmax_t bytes = plain ? std::filesystem::file_size(path, code) : 0;
    std::ifstream stream;
    if (plain && !code) {
        stream.open(path, std::ios::binary);
    }
    if (!stream.is_open()) {
        fail("{}: no such recipe file, or it cannot be read; shipped recipes go by name ('gnomon list recipes')",
             where);
    }
    if (bytes > max_recipe_bytes) {
        fail("{}: {} bytes are too many for a recipe; at most {} are read", where, bytes, max_recipe_bytes);
    }
    std::stringstream text;
    text << stream.rdbuf();
    try {
        return toml::parse(text.str(), path.string());
    } catch (const toml::parse_error& error) {
        fail("{}: line {} is not valid TOML: {}", where, error.source().begin.line, error.description());
    }
}

struct Override {
    std::string_view key, value;
};

/// The list's key=value, in order.
std::vector<Override> overrides_of(std::string_view text, const std::string& where) {
    std::vector<Override> list;
    while (!text.empty()) {
        // Cut the next key=value off the list.
        const std::size_t comma = std::min(text.find(','), text.size());
        const std::string_view item = without_blanks(text.substr(0, comma));
        text.remove_prefix(std::min(text.size(), comma + 1));
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos || equals == 0) {
            fail("{}: '{}' is no override; they are written key=value and separated by commas", where, item);
        }
        list.push_back({without_blanks(item.substr(0, equals)), without_blanks(item.substr(equals + 1))});
    }
    return list;
}

void apply_overrides(Recipe& recipe, std::string_view text) {
    const std::string where = fmt::format("-r {}", recipe.name);
    const std::vector<Override> overrides = overrides_of(text, where);
    // Where a combination is asked for, wherever that stands, a direct part does not take a map's place.
    const bool combines = std::any_of(overrides.begin(), overrides.end(),
                                      [](const Override& override) { return override.key == "combine"; });
    recipe.combine = combines && !recipe.combine ? std::optional(Combine::product) : recipe.combine;

    std::vector<RecipeKey> keys;
    for (const auto& [key, value] : overrides) {
        // Take it as a top-level key, or as group.name.
        const std::size_t dot = key.find('.');
        if (dot != std::string_view::npos) {
            set_group(recipe, key.substr(0, dot), key.substr(dot + 1), value, where);
            remember(keys, key.substr(0, dot), key.substr(dot + 1), recipe);
        } else if (set_top_level(recipe, key, value, where)) {
            remember(keys, "", key, recipe);
        } else {
            fail_unknown_key(recipe, key, where);
        }
        recipe.overrides += fmt::format("{}{}={}", recipe.overrides.empty() ? "" : ",", key, value);
    }
    // A file's combination ends where one of its two sides is taken away.
    if (!combines && !has_both(recipe)) {
        recipe.combine.reset();
    }
    check_combine(recipe, where);
    check_complete(recipe);
    check_keys(recipe, keys, where);
}

}  // namespace

const ParamBlock& Recipe::block(const Part& part) const {
    const auto found = params.find(part.id);
    GN_CHECK(found != params.end());
    return found->second;
}

std::vector<const Part*> Recipe::parts() const {
    std::vector<const Part*> named;
    for (const Part* part : {light, placement, map, translucent_map, lookup, translucent_lookup, direct}) {
        // One part may serve both classes of casters.
        if (part != nullptr && std::find(named.begin(), named.end(), part) == named.end()) {
            named.push_back(part);
        }
    }
    named.insert(named.end(), visibility.begin(), visibility.end());
    return named;
}

Recipe Recipe::of_translucent() const {
    Recipe recipe = *this;
    recipe.map = translucent_map;
    recipe.lookup = translucent_lookup;
    recipe.casters = Casters::all;
    return recipe;
}

const Part& Recipe::placement_for(const GnLight& shape) const {
    if (placement != nullptr && placement->lights.has(shape.kind)) {
        return *placement;
    }
    const std::span<const Part* const> parts = all_parts();
    const auto found =
        std::find_if(parts.begin(), parts.end(), [&](const Part* part) { return part->stands_in_for.has(shape.kind); });
    GN_CHECK(found != parts.end());
    return **found;
}

std::string Recipe::placement_name() const {
    return placement == nullptr ? "auto" : std::string(placement->id) + (placement_or_auto ? "+auto" : "");
}

std::filesystem::path recipe_file(const std::string& name, const std::filesystem::path& data) {
    if (is_path(name)) {
        return name;
    }
    const std::vector<std::string> names = recipe_names(data);
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const std::string& known) { return identifier(known) == identifier(name); });
    if (found == names.end()) {
        const std::vector<std::string_view> known(names.begin(), names.end());
        fail("unknown recipe '{}'; {}, or the path of a .toml file", name, suggest(name, known));
    }
    return recipes_of(data) / (*found + ".toml");
}

Recipe load_recipe(const std::string& name_and_overrides, const std::filesystem::path& data) {
    // Start from every part's defaults.
    Recipe recipe;
    for (const Part* part : all_parts()) {
        recipe.params.try_emplace(std::string(part->id), part->params);
    }
    // Read the file, then lay the overrides over it.
    const std::size_t comma = name_and_overrides.find(',');
    const std::string name(without_blanks(std::string_view(name_and_overrides).substr(0, comma)));
    const std::filesystem::path path = recipe_file(name, data);
    recipe.name = path.stem().string();
    const std::string where = is_path(name) ? name : fmt::format("recipe {}", recipe.name);
    read_table(recipe, read_file(path, where), where);
    apply_overrides(recipe, comma == std::string::npos ? "" : std::string_view(name_and_overrides).substr(comma + 1));
    return recipe;
}

std::vector<std::string> recipe_names(const std::filesystem::path& data) {
    std::vector<std::string> names;
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(recipes_of(data), code)) {
        if (entry.path().extension() == ".toml") {
            names.push_back(entry.path().stem().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace gn
