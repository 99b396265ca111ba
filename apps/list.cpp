// SPDX-License-Identifier: MIT
#include "apps/choose.h"
#include "apps/options.h"
#include "apps/terminal.h"
#include "shadow/metrics/metrics.h"
#include "shadow/recipe/recipe.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>

namespace gn {
namespace {

using nlohmann::ordered_json;

/// One kind of thing: its entries as JSON, and which of their fields the text shows.
struct Kind {
    std::string_view name;
    std::vector<std::string> fields;
    ordered_json (*entries)();
};

ordered_json parts() {
    ordered_json list = ordered_json::array();
    for (const Part* part : all_parts()) {
        ordered_json params = ordered_json::array();
        for (const ParamRow& row : part->params.rows) {
            params.push_back(row.name);
        }
        list.push_back({{"stage", stage_names[static_cast<std::size_t>(part->stage)]},
                        {"id", part->id},
                        {"title", part->title},
                        {"lights", part->lights.names()},
                        {"citation", part->citation},
                        {"parameters", params}});
    }
    return list;
}

/// The stages that a recipe uses, in order, each with its parts: {"stage": "visibility", "parts": ["bilateral"]}.
ordered_json stages_of(const Recipe& recipe) {
    ordered_json stages = ordered_json::array();
    for (const Part* part : recipe.parts()) {
        const std::string_view stage = stage_names[static_cast<std::size_t>(part->stage)];
        if (stages.empty() || stages.back().at("stage") != stage) {
            stages.push_back({{"stage", stage}, {"parts", ordered_json::array()}});
        }
        stages.back().at("parts").push_back(part->id);
    }
    return stages;
}

ordered_json recipes() {
    ordered_json list = ordered_json::array();
    for (const std::string& name : recipe_names()) {
        const std::optional<Recipe> found = recipe_if_sound(name);
        if (!found) {
            continue;
        }
        const Recipe& recipe = *found;
        list.push_back(
            {{"name", name}, {"title", recipe.title}, {"citation", recipe.citation}, {"stages", stages_of(recipe)}});
    }
    return list;
}

ordered_json scenes() {
    ordered_json list = ordered_json::array();
    for (const BuiltinScene& scene : builtin_scenes()) {
        list.push_back({{"name", scene.name}, {"sentence", scene.sentence}, {"parameters", scene.parameters}});
    }
    return list;
}

ordered_json metrics() {
    ordered_json list = ordered_json::array();
    for (const MetricInfo& metric : all_metrics()) {
        list.push_back({{"name", metric.name}, {"sentence", metric.sentence}});
    }
    return list;
}

const std::array<Kind, 4>& kinds() {
    static const std::array<Kind, 4> all{Kind{"parts", {"stage", "id", "title", "lights", "citation"}, parts},
                                         Kind{"recipes", {"name", "title", "citation"}, recipes},
                                         Kind{"scenes", {"name", "sentence", "parameters"}, scenes},
                                         Kind{"metrics", {"name", "sentence"}, metrics}};
    return all;
}

void print_text(const Kind& kind, const ordered_json& entries) {
    std::vector<std::vector<std::string>> rows;
    for (const ordered_json& entry : entries) {
        std::vector<std::string> row;
        for (const std::string& field : kind.fields) {
            row.push_back(entry.at(field).get<std::string>());
        }
        rows.push_back(row);
    }
    fmt::print("{}\n", text_table(kind.fields, rows, kind.fields.size()));
}

}  // namespace

int run(const ListOptions& options) {
    // Check the one word there is.
    std::vector<std::string_view> known;
    for (const Kind& kind : kinds()) {
        known.push_back(kind.name);
    }
    if (!options.what.empty() && std::find(known.begin(), known.end(), options.what) == known.end()) {
        throw InputError(fmt::format("list: '{}' cannot be listed; {}", options.what, suggest(options.what, known)));
    }
    // The text is made from the same entries as the JSON.
    ordered_json document = ordered_json::object();
    for (const Kind& kind : kinds()) {
        if (!options.what.empty() && options.what != kind.name) {
            continue;
        }
        const ordered_json entries = kind.entries();
        document[std::string(kind.name)] = entries;
        if (!options.json) {
            fmt::print("{}", options.what.empty() ? fmt::format("{}\n", kind.name) : "");
            print_text(kind, entries);
        }
    }
    if (options.json) {
        fmt::print("{}\n", document.dump(2, ' ', false, ordered_json::error_handler_t::replace));
    }
    return exit_done;
}

}  // namespace gn
