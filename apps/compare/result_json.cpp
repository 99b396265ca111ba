// SPDX-License-Identifier: MIT
#include "apps/compare/result.h"

#include "base/error.h"
#include "base/stats.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

using nlohmann::ordered_json;

ordered_json number(std::optional<double> value) {
    return value && std::isfinite(*value) ? ordered_json(*value) : ordered_json(nullptr);
}

std::optional<double> optional_number(const ordered_json& json) {
    return json.is_number() ? std::optional<double>(json.get<double>()) : std::nullopt;
}

ordered_json errors_json(const Errors& errors) {
    ordered_json json = ordered_json::object();
    for (const MetricInfo& metric : all_metrics()) {
        json[std::string(metric.name)] = number(errors.*metric.value);
    }
    return json;
}

ordered_json weighted_json(const WeightedErrors& errors) {
    ordered_json json = ordered_json::object();
    for (const WeightedInfo& metric : weighted_metrics()) {
        json[std::string(metric.name)] = number(errors.*metric.value);
    }
    return json;
}

WeightedErrors weighted_from(const ordered_json& json) {
    WeightedErrors errors;
    for (const WeightedInfo& metric : weighted_metrics()) {
        errors.*metric.value = optional_number(json.at(std::string(metric.name)));
    }
    return errors;
}

/// What leak, acne and penumbra are means of.
ordered_json found_json(const Errors& errors) {
    return {{"dark", errors.dark}, {"lit", errors.lit}, {"partial", errors.partial}};
}

/// Of a light or a run.
Errors errors_from(const ordered_json& json) {
    Errors errors;
    errors.samples = json.at("samples");
    errors.dark = json.at("found").at("dark");
    errors.lit = json.at("found").at("lit");
    errors.partial = json.at("found").at("partial");
    for (const MetricInfo& metric : all_metrics()) {
        errors.*metric.value = optional_number(json.at("error").at(std::string(metric.name)));
    }
    errors.weighted = weighted_from(json.at("weighted"));
    return errors;
}

ordered_json spread_json(const Spread& spread) {
    return {{"median", number(spread.median)}, {"min", number(spread.min)}, {"max", number(spread.max)}};
}

Spread spread_from(const ordered_json& json) {
    return {optional_number(json.at("median")), optional_number(json.at("min")), optional_number(json.at("max"))};
}

Status status_from(const ordered_json& json) {
    const auto found = std::find(status_names.begin(), status_names.end(), json.get<std::string>());
    if (found == status_names.end()) {
        fail("no status is called {}", json.dump());
    }
    return static_cast<Status>(found - status_names.begin());
}

ordered_json light_json(const LightResult& light, bool for_report) {
    ordered_json json{{"name", light.name},
                      {"status", name_of(light.status)},
                      {"reason", light.reason},
                      {"samples", light.errors.samples},
                      {"found", found_json(light.errors)},
                      {"error", errors_json(light.errors)},
                      {"weighted", weighted_json(light.errors.weighted)}};
    if (!light.path_texels.empty()) {
        json["path_texels"] = ordered_json::array();
        for (const ivec2& texels : light.path_texels) {
            json["path_texels"].push_back({texels.x, texels.y});
        }
    }
    if (for_report) {
        json["error_map"] = light.error_map;
    }
    return json;
}

std::vector<ivec2> texels_from(const ordered_json& light) {
    std::vector<ivec2> frames;
    for (const ordered_json& texels : light.value("path_texels", ordered_json::array())) {
        frames.emplace_back(texels.at(0).get<int>(), texels.at(1).get<int>());
    }
    return frames;
}

ordered_json times_json(const RunResult& run) {
    ordered_json passes = ordered_json::array();
    for (const PassResult& pass : run.passes) {
        passes.push_back({{"name", pass.name}, {"group", pass.group}, {"median", pass.median}});
    }
    return {{"shadow", spread_json(run.shadow)}, {"frame", spread_json(run.frame)}, {"passes", passes}};
}

ordered_json memory_json(const RunResult& run) {
    ordered_json resources = ordered_json::array();
    for (const ResourceResult& resource : run.resources) {
        resources.push_back({{"name", resource.name}, {"bytes", resource.bytes}});
    }
    return {{"bytes", run.bytes}, {"resources", resources}};
}

void add_report_fields(ordered_json& json, const RunResult& run) {
    json["title"] = run.title;
    json["citation"] = run.citation;
    json["paragraph"] = run.paragraph;
    json["picture"] = run.picture;
    json["error_map"] = run.error_map;
    json["command"] = run.command;
    json["parameters"] = ordered_json::array();
    for (const auto& [name, value] : run.parameters) {
        json["parameters"].push_back({{"name", name}, {"value", value}});
    }
    json["inside"] = ordered_json::array();
    for (const InsideResult& shown : run.inside) {
        json["inside"].push_back({{"name", shown.name},
                                  {"light", shown.light},
                                  {"picture", shown.picture},
                                  {"legend", shown.legend},
                                  {"of_view", shown.of_view}});
    }
    json["path"] = run.path;
    json["path_flicker"] = ordered_json::array();
    for (const std::optional<double>& step : run.path_flicker) {
        json["path_flicker"].push_back(number(step));
    }
}

ordered_json scene_json(const SceneResult& scene, bool for_report) {
    ordered_json lights = ordered_json::array();
    for (const LightInfo& light : scene.lights) {
        lights.push_back({{"name", light.name}, {"kind", light.kind}, {"size", light.size}});
    }
    ordered_json json{{"scene", scene.scene},         {"name", scene.name},
                      {"view", scene.view},           {"size", {scene.width, scene.height}},
                      {"triangles", scene.triangles}, {"lights", lights},
                      {"notes", scene.notes}};
    if (for_report) {
        json["reference"] = reference_json(scene.reference);
    }
    return json;
}

/// All references as one: seconds add up, standard errors are averaged over the scenes that have one.
ordered_json overall_reference(const Comparison& comparison) {
    double seconds = 0, standard_error = 0;
    int traced = 0;
    for (const SceneResult& scene : comparison.scenes) {
        seconds += scene.reference.seconds;
        standard_error += scene.reference.standard_error;
        traced += scene.reference.samples > 0 ? 1 : 0;
    }
    const ordered_json mean = traced > 0 ? ordered_json(standard_error / traced) : ordered_json(nullptr);
    return {{"samples", comparison.samples}, {"seconds", seconds}, {"standard_error", mean}};
}

ordered_json document(const Comparison& comparison, bool for_report) {
    ordered_json scenes = ordered_json::array(), runs = ordered_json::array();
    for (const SceneResult& scene : comparison.scenes) {
        scenes.push_back(scene_json(scene, for_report));
    }
    for (const RunResult& run : comparison.runs) {
        runs.push_back(run_json(run, for_report));
    }
    ordered_json json{{"schema", schema_version},
                      {"version", GNOMON_VERSION},
                      {"device",
                       {{"name", comparison.device.name},
                        {"kind", comparison.device.cpu ? "cpu" : "gpu"},
                        {"driver", comparison.device.driver}}},
                      {"reference", overall_reference(comparison)},
                      {"scenes", scenes},
                      {"runs", runs}};
    return json;
}

}  // namespace

Spread spread_of(const std::vector<double>& values) {
    if (values.empty()) {
        return {};
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return {median(values), *least, *most};
}

ordered_json run_json(const RunResult& run, bool for_report) {
    ordered_json lights = ordered_json::array();
    for (const LightResult& light : run.lights) {
        lights.push_back(light_json(light, for_report));
    }
    ordered_json json{{"scene", run.scene},
                      {"view", run.view},
                      {"recipe", run.recipe},
                      {"overrides", run.overrides},
                      {"size", {run.width, run.height}},
                      {"status", name_of(run.status)},
                      {"reason", run.reason},
                      {"samples", run.errors.samples},
                      {"found", found_json(run.errors)},
                      {"error", errors_json(run.errors)},
                      {"weighted", weighted_json(run.errors.weighted)},
                      {"lights", lights},
                      {"time_ms", times_json(run)},
                      {"memory", memory_json(run)},
                      {"remarks", run.remarks}};
    if (run.shaded_luma_rms) {
        json["shaded"] = {{"luma_rms", number(run.shaded_luma_rms)}, {"flip", number(run.shaded_flip)}};
    }
    if (for_report) {
        add_report_fields(json, run);
    }
    return json;
}

RunResult run_from_json(const ordered_json& json) {
    RunResult run;
    // What was asked for, and how it ended.
    run.scene = json.at("scene");
    run.view = json.at("view");
    run.recipe = json.at("recipe");
    run.overrides = json.at("overrides");
    run.width = json.at("size").at(0);
    run.height = json.at("size").at(1);
    run.status = status_from(json.at("status"));
    run.reason = json.at("reason");
    // The figures.
    run.errors = errors_from(json);
    if (json.contains("shaded")) {
        run.shaded_luma_rms = optional_number(json.at("shaded").at("luma_rms"));
        run.shaded_flip = optional_number(json.at("shaded").at("flip"));
    }
    for (const ordered_json& light : json.at("lights")) {
        run.lights.push_back({light.at("name"), status_from(light.at("status")), light.at("reason"), errors_from(light),
                              light.at("error_map"), texels_from(light)});
    }
    run.shadow = spread_from(json.at("time_ms").at("shadow"));
    run.frame = spread_from(json.at("time_ms").at("frame"));
    for (const ordered_json& pass : json.at("time_ms").at("passes")) {
        run.passes.push_back({pass.at("name"), pass.at("group"), pass.at("median")});
    }
    run.bytes = json.at("memory").at("bytes");
    for (const ordered_json& resource : json.at("memory").at("resources")) {
        run.resources.push_back({resource.at("name"), resource.at("bytes")});
    }
    // What the report shows besides.
    run.title = json.at("title");
    run.citation = json.at("citation");
    run.paragraph = json.at("paragraph");
    run.picture = json.at("picture");
    run.error_map = json.at("error_map");
    run.command = json.at("command");
    for (const ordered_json& parameter : json.at("parameters")) {
        run.parameters.emplace_back(parameter.at("name"), parameter.at("value"));
    }
    for (const ordered_json& shown : json.at("inside")) {
        run.inside.push_back(
            {shown.at("name"), shown.at("light"), shown.at("picture"), shown.at("legend"), shown.at("of_view")});
    }
    run.remarks = json.at("remarks");
    run.path = json.at("path");
    for (const ordered_json& step : json.at("path_flicker")) {
        run.path_flicker.push_back(optional_number(step));
    }
    return run;
}

ordered_json reference_json(const ReferenceResult& reference) {
    return {{"samples", reference.samples},
            {"seconds", reference.seconds},
            {"standard_error", reference.standard_error},
            {"picture", reference.picture}};
}

ReferenceResult reference_from_json(const ordered_json& json) {
    return {json.at("samples"), json.at("seconds"), json.at("standard_error"), json.at("picture")};
}

ordered_json contract_json(const Comparison& comparison) {
    return document(comparison, false);
}

ordered_json report_json(const Comparison& comparison) {
    ordered_json json = document(comparison, true);
    json["command"] = comparison.command;
    json["against"] = comparison.against;
    json["repeat"] = comparison.repeat;
    json["metrics"] = ordered_json::array();
    for (const MetricInfo& metric : all_metrics()) {
        json["metrics"].push_back({{"name", metric.name}, {"sentence", metric.sentence}});
    }
    return json;
}

std::string dump(const ordered_json& json, int indent) {
    return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace gn
