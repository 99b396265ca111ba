// SPDX-License-Identifier: MIT
// Manual pages, put together from a part's .md and its parameter rows, or from a recipe's file.
#include "apps/choose.h"
#include "apps/options.h"
#include "apps/terminal.h"
#include "base/paths.h"
#include "shadow/metrics/metrics.h"
#include "shadow/recipe/recipe.h"
#include "shadow/recipe/recipe_set.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace gn {
namespace {

std::string_view stage_of(const Part& part) {
    return stage_names[static_cast<std::size_t>(part.stage)];
}

std::string range_of(const ParamRow& row) {
    switch (row.type) {
        case ParamType::boolean: return "true, false";
        case ParamType::choice: {
            std::string list;
            for (const std::string_view choice : row.choices) {
                list += fmt::format("{}{}", list.empty() ? "" : ", ", choice);
            }
            return list;
        }
        default: return fmt::format("{} to {}", row.min, row.max);
    }
}

/// Name, value, range, unit and consequence of every parameter of a block.
std::string parameter_table(const ParamBlock& block, std::string_view group, const std::string& value_title) {
    std::vector<std::vector<std::string>> rows;
    for (const ParamRow& row : block.table()->rows) {
        rows.push_back({fmt::format("{}.{}", group, row.name), block.get(row.name), range_of(row),
                        std::string(row.unit), std::string(row.sentence)});
    }
    return text_table({"parameter", value_title, "range", "unit", "consequence"}, rows, 5);
}

/// The recipes that name the part.
std::string users_of(const Part& part) {
    std::string list;
    for (const std::string& name : recipe_names()) {
        const std::optional<Recipe> recipe = recipe_if_sound(name);
        if (!recipe) {
            continue;
        }
        for (const Part* used : recipe->parts()) {
            if (used == &part) {
                list += (list.empty() ? "" : ", ") + name;
            }
        }
    }
    return list.empty() ? "none that names it" : list;
}

/// A page's pictures as their files' names: ![what](../../../docs/pictures/x.png) becomes docs/pictures/x.png.
std::string with_plain_pictures(std::string text) {
    for (std::size_t at = 0; (at = text.find("![", at)) != std::string::npos;) {
        const std::size_t path = text.find("](", at);
        const std::size_t end = text.find_first_of(")\n", path);
        if (path == std::string::npos || end == std::string::npos || text[end] != ')') {
            break;
        }
        std::string name = text.substr(path + 2, end - path - 2);
        while (name.starts_with("../")) {
            name.erase(0, 3);
        }
        text.replace(at, end + 1 - at, name);
        at += name.size();
    }
    return text;
}

/// The part's page without the lines between its first two "---", which repeat what is printed above it.
std::string page_of(const Part& part) {
    const std::string name = identifier(part.id);
    std::ifstream file(data_root() / "shadow" / stage_of(part) / name / (name + ".md"), std::ios::binary);
    std::stringstream stream;
    stream << file.rdbuf();
    const std::string text = stream.str();
    const std::size_t end = text.starts_with("---\n") ? text.find("\n---\n", 3) : std::string::npos;
    const std::size_t body = end == std::string::npos ? 0 : text.find_first_not_of('\n', end + 5);
    return body == std::string::npos ? "" : with_plain_pictures(text.substr(body));
}

void show_part(const Part& part) {
    fmt::print("{} '{}': {}\n\n", stage_of(part), part.id, part.title);
    // What a reader of the table of contents wants to know first.
    std::string features;
    for (const Feature feature : part.features) {
        features += fmt::format("{}{}", features.empty() ? "" : ", ", feature_name(feature));
    }
    const std::vector<std::string_view> read = words_read(part);
    const std::vector<std::string_view> given = words_given(part);
    fmt::print("  source    [{}]\n  lights    {}\n", part.citation, part.lights.names());
    fmt::print("{}", read.empty() ? "" : fmt::format("  reads     maps that give {}\n", fmt::join(read, ", ")));
    fmt::print("{}", given.empty() ? "" : fmt::format("  gives     {}\n", fmt::join(given, ", ")));
    fmt::print("{}", features.empty() ? "" : fmt::format("  features  {}\n", features));
    fmt::print("  recipes   {}\n\n", users_of(part));
    // The page itself, then the rows.
    const std::string page = page_of(part);
    fmt::print("{}{}", page, page.empty() ? "" : "\n");
    if (part.params.rows.empty()) {
        fmt::print("It has no parameters.\n");
    } else {
        fmt::print("{}", parameter_table(ParamBlock(part.params), part.id, "default"));
    }
}

std::string part_name(const Part* part, std::string_view absent) {
    return std::string(part ? part->id : absent);
}

/// As a recipe's key has them: "one+another", or "none".
std::string visibility_names(const Recipe& recipe) {
    std::string names;
    for (const Part* part : recipe.visibility) {
        names += fmt::format("{}{}", names.empty() ? "" : "+", part->id);
    }
    return names.empty() ? "none" : names;
}

void show_recipe(const std::string& name) {
    const Recipe recipe = load_recipe(name);
    const bool mapped = recipe.map != nullptr, split = recipe.light != nullptr;
    fmt::print("recipe '{}': {}\n\n{}\n\n", recipe.name, recipe.title, recipe.paragraph);
    // Its parts in flow order.
    fmt::print("  source      [{}]\n", recipe.citation);
    fmt::print("{}", split ? fmt::format("  light       {}\n", recipe.light->id) : "");
    if (mapped) {
        fmt::print("  placement   {}\n  map         {}\n  lookup      {}\n", recipe.placement_name(),
                   part_name(recipe.map, "none"), part_name(recipe.lookup, "none"));
        fmt::print("  resolution  {} texels a side, of {} to {}\n", recipe.resolution, min_resolution, max_resolution);
        fmt::print("  casters     {}, of {}\n", name_of(recipe.casters), fmt::join(caster_names, ", "));
    }
    if (recipe.translucent_map != nullptr) {
        fmt::print("  translucent map {}, lookup {}\n", recipe.translucent_map->id,
                   part_name(recipe.translucent_lookup, "none"));
    }
    if (!mapped || recipe.direct != nullptr) {
        fmt::print("  direct      {}\n", part_name(recipe.direct, "none"));
    }
    if (recipe.combine) {
        fmt::print("  combine     {}, of {}\n", combine_names.at(static_cast<std::size_t>(*recipe.combine)),
                   fmt::join(combine_names, ", "));
    }
    fmt::print("  visibility  {}\n", visibility_names(recipe));
    // The parameters that take part, as this recipe sets them.
    for (const Part* part : recipe.parts()) {
        if (!part->params.rows.empty()) {
            fmt::print("\n{}", parameter_table(recipe.block(*part), part->id, "value"));
        }
    }
    if (mapped) {
        const ParamTable bias = bias_table(recipe.bias);
        fmt::print("\n{}", parameter_table(ParamBlock(bias), "bias", "value"));
    }
}

void show_scene(const BuiltinScene& scene) {
    fmt::print("scene '{}': {}\n", scene.name, scene.sentence);
    fmt::print("{}", scene.parameters.empty()
                         ? "It has no parameters.\n"
                         : fmt::format("Parameters, written {}:name=value: {}\n", scene.name, scene.parameters));
}

/// Shows everything of that name and returns how many things there were.
int show_all(const std::string& id) {
    int shown = 0;
    const auto next = [&] { fmt::print("{}", shown++ == 0 ? "" : "\n\n"); };
    const std::string name = identifier(id);
    for (const std::string& recipe : recipe_names()) {
        if (identifier(recipe) == name) {
            next();
            show_recipe(recipe);
        }
    }
    for (const Part* part : all_parts()) {
        if (identifier(part->id) == name || identifier(fmt::format("{}/{}", stage_of(*part), part->id)) == name) {
            next();
            show_part(*part);
        }
    }
    for (const BuiltinScene& scene : builtin_scenes()) {
        if (identifier(scene.name) == name) {
            next();
            show_scene(scene);
        }
    }
    for (const MetricInfo& metric : all_metrics()) {
        if (identifier(metric.name) == name) {
            next();
            fmt::print("metric '{}': {}\n", metric.name, metric.sentence);
        }
    }
    return shown;
}

[[noreturn]] void fail_unknown(const std::string& id) {
    std::vector<std::string> names = recipe_names();
    for (const Part* part : all_parts()) {
        names.emplace_back(part->id);
    }
    for (const BuiltinScene& scene : builtin_scenes()) {
        names.push_back(scene.name);
    }
    for (const MetricInfo& metric : all_metrics()) {
        names.emplace_back(metric.name);
    }
    names.emplace_back("bias");
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const std::vector<std::string_view> known(names.begin(), names.end());
    throw InputError(fmt::format("show: nothing is called '{}'; {}", id, suggest(id, known)));
}

}  // namespace

int run(const ShowOptions& options) {
    // Bias belongs to every map recipe and to no part.
    if (options.id == "bias") {
        fmt::print("bias: moves the receiver before it is compared, in every recipe with a map\n\n{}",
                   parameter_table(ParamBlock(bias_params), "bias", "default"));
        return exit_done;
    }
    const bool file = options.id.ends_with(".toml");
    if (file) {
        reading([&] { show_recipe(options.id); });
    } else if (show_all(options.id) == 0) {
        fail_unknown(options.id);
    }
    return exit_done;
}

}  // namespace gn
