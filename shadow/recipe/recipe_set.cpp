// SPDX-License-Identifier: MIT
#include "shadow/recipe/recipe_set.h"

#include <algorithm>
#include <array>
#include <charconv>

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

constexpr std::array<std::string_view, 10> top_level_keys{"light",   "placement",  "map",        "lookup",  "direct",
                                                          "combine", "visibility", "resolution", "casters", "bias"};

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

}  // namespace

ParamTable bias_table(const GnBias& bias) {
    ParamTable table = bias_params;
    std::memcpy(table.defaults.data(), &bias, sizeof bias);
    return table;
}

namespace {

void set_bias(GnBias& bias, std::string_view name, std::string_view value, const std::string& where) {
    const ParamTable current = bias_table(bias);
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

const Part& find_named(Stage stage, std::string_view name, const std::string& where) {
    try {
        return find_part(stage, name);
    } catch (const Error& error) {
        fail("{}: {}{}", where, error.what(), stage == Stage::placement ? ", auto" : ", none");
    }
}

/// A stage's part by name; null for the word that leaves the stage out.
const Part* named_part(Stage stage, std::string_view name, std::string_view absent, const std::string& where) {
    return name == absent ? nullptr : &find_named(stage, name, where);
}

/// The parts of "one+another", in this order; none for "none".
std::vector<const Part*> named_parts(Stage stage, std::string_view names, const std::string& where) {
    std::vector<const Part*> parts;
    for (std::size_t first = 0; first <= names.size();) {
        const std::size_t end = std::min(names.find('+', first), names.size());
        const std::string_view name = without_blanks(names.substr(first, end - first));
        const Part* part = names == "none" ? nullptr : &find_named(stage, name, where);
        if (std::find(parts.begin(), parts.end(), part) != parts.end()) {
            fail("{}: {} = {} names '{}' twice; each part stands once, with one set of parameters", where,
                 stage_names[static_cast<std::size_t>(stage)], names, name);
        }
        if (part != nullptr) {
            parts.push_back(part);
        }
        first = end + 1;
    }
    return parts;
}

/// The place of a value among those that a key may have.
std::size_t named_of(std::span<const std::string_view> valid, std::string_view key, std::string_view value,
                     const std::string& where) {
    const auto named = std::find(valid.begin(), valid.end(), value);
    if (named == valid.end()) {
        fail("{}: {} = {} is not valid; {}", where, key, value, suggest(value, valid));
    }
    return static_cast<std::size_t>(named - valid.begin());
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\n");
    return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(" \t\n") + 1 - first);
}

bool set_top_level(Recipe& recipe, std::string_view key, std::string_view value, const std::string& where) {
    if (key == "light") {
        recipe.light = named_part(Stage::light, value, "none", where);
    } else if (key == "placement") {
        // "cascades+auto": where it serves, and where no light is one that it serves as the lights' kind says.
        const std::string_view first = without_blanks(value.substr(0, value.find('+')));
        const bool more = value.find('+') != std::string_view::npos;
        if (more && (first == "auto" || without_blanks(value.substr(value.find('+') + 1)) != "auto")) {
            fail("{}: placement = {} is not valid; behind a placement may stand +auto alone, as in cascades+auto",
                 where, value);
        }
        recipe.placement = named_part(Stage::placement, first, "auto", where);
        recipe.placement_or_auto = more;
    } else if (key == "map") {
        recipe.map = named_part(Stage::map, value, "none", where);
        recipe.direct = recipe.map != nullptr && !recipe.combine ? nullptr : recipe.direct;
    } else if (key == "lookup") {
        recipe.lookup = named_part(Stage::lookup, value, "none", where);
        recipe.direct = recipe.lookup != nullptr && !recipe.combine ? nullptr : recipe.direct;
    } else if (key == "direct") {
        recipe.direct = named_part(Stage::direct, value, "none", where);
        if (recipe.direct != nullptr && !recipe.combine) {
            recipe.placement = recipe.map = recipe.lookup = nullptr;
        }
    } else if (key == "combine") {
        recipe.combine = static_cast<Combine>(named_of(combine_names, key, value, where));
    } else if (key == "visibility") {
        recipe.visibility = named_parts(Stage::visibility, value, where);
    } else if (key == "resolution") {
        recipe.resolution = parse_resolution(value, where);
    } else if (key == "casters") {
        recipe.casters = static_cast<Casters>(named_of(caster_names, key, value, where));
    } else {
        return false;
    }
    return true;
}

void fail_unknown_key(const Recipe& recipe, std::string_view key, const std::string& where) {
    std::vector<std::string_view> known(top_level_keys.begin(), top_level_keys.end());
    known.emplace_back("translucent");
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
    if (group == "translucent" && name == "map") {
        recipe.translucent_map = named_part(Stage::map, value, "none", place);
        return;
    }
    if (group == "translucent" && name == "lookup") {
        recipe.translucent_lookup = named_part(Stage::lookup, value, "none", place);
        return;
    }
    for (auto& [id, block] : recipe.params) {
        if (identifier(id) == identifier(group)) {
            return set_param(block, name, value, place);
        }
    }
    fail_unknown_key(recipe, group, where);
}

}  // namespace gn
