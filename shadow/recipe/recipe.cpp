// SPDX-License-Identifier: MIT
#include "shadow/recipe/recipe.h"

#include "base/paths.h"
#include "shadow/recipe/check_recipe.h"
#include "shadow/recipe/recipe_keys.h"

#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gn {

const ParamTable bias_params = param_table<GnBias>({
    GN_PARAM(GnBias, constant, real, 0, 64, "texels", "Less acne on every surface, and a wider gap under contacts."),
    GN_PARAM(GnBias, constant_world, real, 0, 10, "m", "The same in metres: independent of the map's resolution."),
    GN_PARAM(GnBias, slope, real, 0, 64, "texels", "Less acne at grazing light, and a wider gap there."),
    GN_PARAM(GnBias, slope_max, real, 0, 1000, "", "Lets the slope bias grow further towards grazing light."),
    GN_PARAM(GnBias, normal, real, 0, 64, "texels",
             "Less acne at grazing light; thin casters lose their shadow's rim."),
    GN_PARAM(GnBias, normal_world, real, 0, 10, "m", "The same in metres: independent of the map's resolution."),
    GN_PARAM(GnBias, receiver_plane, boolean, 0, 1, "",
             "Wide kernels follow the receiver's plane, which removes their acne and costs two dot products a tap."),
    GN_PARAM(GnBias, cone, real, 0, 64, "texels",
             "Lifts each tap by this much a texel of its distance, with receiver_plane only where the plane falls "
             "away: less acne in lit creases, more leaks there."),
    GN_PARAM(GnBias, view, real, 0, 64, "texels",
             "Moves the receiver towards the camera: less acne on surfaces that face it, a gap that moves with it."),
    GN_PARAM(GnBias, view_world, real, 0, 10, "m", "The same in metres: independent of the map's resolution."),
    GN_PARAM(GnBias, kernel, real, 0, 4, "",
             "Without receiver_plane, biases in texels grow by this share of what the kernel's reach asks for."),
    GN_PARAM(GnBias, dual, real, 0, 1024, "texels",
             "casters = dual: lets the stored depth lie further behind the nearest surface: less acne, wider gaps."),
    GN_PARAM(GnBias, dual_world, real, 0, 100, "m", "The same in metres, added to dual."),
});

namespace {

constexpr std::uintmax_t max_recipe_bytes = 1U << 20U;
constexpr std::array<std::string_view, 8> top_level_keys{"placement",  "map",        "lookup",  "direct",
                                                         "visibility", "resolution", "casters", "bias"};

/// The row that the user means, with '-' and '_' taken as equal; the name as given where there is none.
std::string_view canonical(const ParamTable& table, std::string_view given) {
    for (const ParamRow& row : table.rows) {
        if (identifier(row.name) == identifier(given)) {
            return row.name;
        }
    }
    return given;
}

void set_param(ParamBlock& block, std::string_view name, std::string_view value, const std::string& where) {
    block.set(block.table() != nullptr ? canonical(*block.table(), name) : name, value, where);
}

void set_bias(GnBias& bias, std::string_view name, std::string_view value, const std::string& where) {
    ParamTable current = bias_params;
    std::memcpy(current.defaults.data(), &bias, sizeof bias);
    ParamBlock block(current);
    set_param(block, name, value, where);
    bias = block.as<GnBias>();
}

int parse_resolution(std::string_view value, const std::string& where) {
    int texels = 0;
    const auto [end, code] = std::from_chars(value.data(), value.data() + value.size(), texels);
    if (code != std::errc{} || end != value.data() + value.size() || texels < min_resolution ||
        texels > max_resolution) {
        fail("{}: resolution = {} is not valid; it is a whole number of texels from {} to {}", where, value,
             min_resolution, max_resolution);
    }
    return texels;
}

/// A stage's part by name; null for the word that leaves the stage out.
const Part* named_part(Stage stage, std::string_view name, std::string_view absent, const std::string& where) {
    if (name == absent) {
        return nullptr;
    }
    try {
        return &find_part(stage, name);
    } catch (const Error& error) {
        fail("{}: {}{}", where, error.what(), absent == "auto" ? ", auto" : ", none");
    }
}

/// Sets a top-level key; false when there is no such key.
bool set_top_level(Recipe& recipe, std::string_view key, std::string_view value, const std::string& where) {
    if (key == "placement") {
        recipe.placement = named_part(Stage::placement, value, "auto", where);
    } else if (key == "map") {
        recipe.map = named_part(Stage::map, value, "none", where);
        recipe.direct = recipe.map != nullptr ? nullptr : recipe.direct;
    } else if (key == "lookup") {
        recipe.lookup = named_part(Stage::lookup, value, "none", where);
        recipe.direct = recipe.lookup != nullptr ? nullptr : recipe.direct;
    } else if (key == "direct") {
        recipe.direct = named_part(Stage::direct, value, "none", where);
        if (recipe.direct != nullptr) {
            recipe.placement = recipe.map = recipe.lookup = nullptr;
        }
    } else if (key == "visibility") {
        recipe.visibility = named_part(Stage::visibility, value, "none", where);
    } else if (key == "resolution") {
        recipe.resolution = parse_resolution(value, where);
    } else if (key == "casters") {
        const auto* const named = std::find(caster_names.begin(), caster_names.end(), value);
        if (named == caster_names.end()) {
            fail("{}: casters = {} is not valid; {}", where, value, suggest(value, caster_names));
        }
        recipe.casters = static_cast<Casters>(named - caster_names.begin());
    } else {
        return false;
    }
    return true;
}

[[noreturn]] void fail_unknown_key(const Recipe& recipe, std::string_view key, const std::string& where) {
    std::vector<std::string_view> known(top_level_keys.begin(), top_level_keys.end());
    for (const auto& [id, block] : recipe.params) {
        if (block.table() != nullptr && !block.table()->rows.empty()) {
            known.push_back(id);
        }
    }
    fail("{}: unknown key '{}'; {}", where, key, suggest(key, known));
}

void set_group(Recipe& recipe, std::string_view group, std::string_view name, std::string_view value,
               const std::string& where) {
    const std::string place = fmt::format("{}: {}.{}", where, group, name);
    if (group == "bias") {
        return set_bias(recipe.bias, name, value, place);
    }
    for (auto& [id, block] : recipe.params) {
        if (identifier(id) == identifier(group)) {
            return set_param(block, name, value, place);
        }
    }
    fail_unknown_key(recipe, group, where);
}

std::string text_of(const toml::node& node, std::string_view key, const std::string& where) {
    if (const auto* text = node.as_string()) {
        return text->get();
    }
    if (const auto* integer = node.as_integer()) {
        return fmt::format("{}", integer->get());
    }
    if (const auto* real = node.as_floating_point()) {
        return fmt::format("{}", real->get());
    }
    if (const auto* boolean = node.as_boolean()) {
        return boolean->get() ? "true" : "false";
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
    // A file that names both kinds of technique means neither.
    if (file.contains("direct") && (file.contains("map") || file.contains("lookup") || file.contains("placement"))) {
        fail("{}: direct stands beside placement, map or lookup; a recipe has either direct or the other three", where);
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
    check_keys(recipe, keys, where);
}

std::string_view without_blanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\n");
    return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(" \t\n") + 1 - first);
}

bool is_path(std::string_view name) {
    return name.ends_with(".toml") || name.find('/') != std::string_view::npos;
}

std::filesystem::path recipe_path(const std::string& name) {
    if (is_path(name)) {
        return name;
    }
    const std::vector<std::string> names = recipe_names();
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const std::string& known) { return identifier(known) == identifier(name); });
    if (found == names.end()) {
        const std::vector<std::string_view> known(names.begin(), names.end());
        fail("unknown recipe '{}'; {}, or the path of a .toml file", name, suggest(name, known));
    }
    return data_root() / "recipes" / (*found + ".toml");
}

toml::table read_file(const std::filesystem::path& path, const std::string& where) {
    // Read the whole file once it is known to be one, and small.
    std::error_code code;
    const std::uintmax_t bytes =
        std::filesystem::is_regular_file(path, code) ? std::filesystem::file_size(path, code) : 0;
    std::ifstream stream(path, std::ios::binary);
    if (code || !stream || !std::filesystem::is_regular_file(path, code)) {
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

void apply_overrides(Recipe& recipe, std::string_view overrides) {
    const std::string where = fmt::format("-r {}", recipe.name);
    std::vector<RecipeKey> keys;
    while (!overrides.empty()) {
        // Cut the next key=value off the list.
        const std::size_t comma = std::min(overrides.find(','), overrides.size());
        const std::string_view item = without_blanks(overrides.substr(0, comma));
        overrides.remove_prefix(std::min(overrides.size(), comma + 1));
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos || equals == 0) {
            fail("{}: '{}' is no override; they are written key=value and separated by commas", where, item);
        }
        // Take it as a top-level key, or as group.name.
        const std::string_view key = without_blanks(item.substr(0, equals));
        const std::string_view value = without_blanks(item.substr(equals + 1));
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
    check_complete(recipe);
    check_keys(recipe, keys, where);
}

}  // namespace

const ParamBlock& Recipe::block(const Part& part) const {
    const auto found = params.find(part.id);
    GN_CHECK(found != params.end());
    return found->second;
}

const Part& Recipe::placement_for(const GnLight& light) const {
    if (placement != nullptr && placement->lights.has(light.kind)) {
        return *placement;
    }
    return find_part(Stage::placement, light.kind == GN_LIGHT_POINT ? "cube" : "fit");
}

Recipe load_recipe(const std::string& name_and_overrides) {
    // Start from every part's defaults.
    Recipe recipe;
    for (const Part* part : all_parts()) {
        recipe.params.try_emplace(std::string(part->id), part->params);
    }
    // Read the file, then lay the overrides over it.
    const std::size_t comma = name_and_overrides.find(',');
    const std::string name(without_blanks(std::string_view(name_and_overrides).substr(0, comma)));
    const std::filesystem::path path = recipe_path(name);
    recipe.name = path.stem().string();
    const std::string where = is_path(name) ? name : fmt::format("recipe {}", recipe.name);
    read_table(recipe, read_file(path, where), where);
    apply_overrides(recipe, comma == std::string::npos ? "" : std::string_view(name_and_overrides).substr(comma + 1));
    return recipe;
}

std::vector<std::string> recipe_names() {
    std::vector<std::string> names;
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(data_root() / "recipes", code)) {
        if (entry.path().extension() == ".toml") {
            names.push_back(entry.path().stem().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace gn
