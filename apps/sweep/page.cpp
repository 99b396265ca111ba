// SPDX-License-Identifier: MIT
#include "apps/sweep/page.h"

#include "apps/compare/publish.h"
#include "apps/compare/result.h"
#include "apps/evaluation/csv.h"
#include "apps/evaluation/limits.h"
#include "apps/options.h"
#include "apps/output.h"
#include "base/paths.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace gn {
namespace {

using nlohmann::ordered_json;

/// One run with its place and its figures by name; a figure that is absent is left out.
struct PlacedRun {
    SweepRun run;
    std::string status, reason, device;
    std::vector<std::pair<std::string, double>> figures;

    [[nodiscard]] std::optional<double> figure(std::string_view name) const {
        for (const auto& [known, value] : figures) {
            if (known == name) {
                return value;
            }
        }
        return std::nullopt;
    }
};

void add_figure(PlacedRun& placed, const std::string& name, const ordered_json& value) {
    if (value.is_number()) {
        placed.figures.emplace_back(name, value.get<double>());
    }
}

void add_figures(PlacedRun& placed, const std::string& document) {
    const ordered_json json = ordered_json::parse(document);
    const ordered_json& time = json.at("time_ms");
    add_figure(placed, "shadow_ms", time.at("shadow").at("median"));
    add_figure(placed, "frame_ms", time.at("frame").at("median"));
    if (placed.status == "ok") {
        add_figure(placed, "bytes", json.at("memory").at("bytes"));
    }
    for (const auto& [name, value] : json.at("error").items()) {
        add_figure(placed, name, value);
    }
    if (json.contains("shaded")) {
        add_figure(placed, "luma_rms_shaded", json.at("shaded").at("luma_rms"));
        add_figure(placed, "flip_shaded", json.at("shaded").at("flip"));
    }
}

/// All runs that the sweep asks for, in its order; those that are not finished have the status "open".
std::vector<PlacedRun> placed_runs(const SweepFile& file, const std::string& where, SweepStore& store) {
    std::map<std::string, SweepRow> rows;
    for (SweepRow& row : store.rows()) {
        rows.emplace(row.key, std::move(row));
    }
    std::vector<PlacedRun> placed;
    for (SweepRun& run : expand(file, where)) {
        PlacedRun one{std::move(run), "open", "", "", {}};
        if (const auto found = rows.find(one.run.key); found != rows.end()) {
            one.status = found->second.status;
            one.reason = found->second.reason;
            one.device = found->second.device;
            if (!found->second.document.empty()) {
                add_figures(one, found->second.document);
            }
        }
        placed.push_back(std::move(one));
    }
    return placed;
}

ordered_json grid_json(const Grid& grid, const std::vector<PlacedRun>& placed) {
    ordered_json axes = ordered_json::array();
    for (const Axis& axis : grid.axes) {
        ordered_json values = ordered_json::array();
        for (const AxisValue& value : axis.values) {
            values.push_back(value.name);
        }
        axes.push_back({{"name", axis.name}, {"values", values}});
    }
    ordered_json runs = ordered_json::array();
    for (const PlacedRun& one : placed) {
        if (one.run.grid != grid.name) {
            continue;
        }
        ordered_json at = ordered_json::array(), figures = ordered_json::object();
        for (const auto& [axis, value] : one.run.at) {
            at.push_back(value);
        }
        for (const auto& [name, value] : one.figures) {
            figures[name] = value;
        }
        runs.push_back({{"at", at},
                        {"status", one.status},
                        {"reason", one.reason},
                        {"scene", one.run.scene},
                        {"recipe", one.run.recipe},
                        {"size", {one.run.width, one.run.height}},
                        {"figures", figures}});
    }
    return {{"name", grid.name}, {"axes", axes}, {"runs", runs}};
}

ordered_json optional_json(const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
}

/// The limits of every combination of the other axes' values.
ordered_json limits_json(const LimitsRequest& request, const std::vector<PlacedRun>& placed) {
    std::vector<std::pair<std::vector<std::string>, std::vector<LimitSample>>> groups;
    std::vector<std::string> others;
    for (const PlacedRun& one : placed) {
        if (one.run.grid != request.grid) {
            continue;
        }
        LimitSample sample;
        std::vector<std::string> rest;
        others.clear();
        for (const auto& [axis, value] : one.run.at) {
            if (axis == request.objects || axis == request.target) {
                (axis == request.objects ? sample.objects : sample.target) = std::stod(value);
            } else {
                rest.push_back(value);
                others.push_back(axis);
            }
        }
        const auto ms = one.figure("frame_ms");
        if (!ms) {
            continue;
        }
        sample.frame_ms = *ms;
        const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == rest; });
        same == groups.end() ? groups.push_back({rest, {sample}}) : same->second.push_back(sample);
    }
    std::sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    ordered_json rows = ordered_json::array();
    for (const double budget : request.budgets_ms) {
        for (const auto& [at, samples] : groups) {
            const Limits limits = limits_of(samples, budget);
            rows.push_back({{"budget_ms", budget},
                            {"at", at},
                            {"samples", samples.size()},
                            {"most", optional_json(limits.most)},
                            {"most_at", optional_json(limits.most_at)},
                            {"at_largest", optional_json(limits.at_largest)},
                            {"largest", limits.largest}});
        }
    }
    return {{"axes", others}, {"objects", request.objects}, {"target", request.target}, {"rows", rows}};
}

ordered_json page_json(const SweepTitle& title, const SweepFile& file, const std::vector<PlacedRun>& placed) {
    std::vector<std::string> devices;
    for (const PlacedRun& one : placed) {
        if (!one.device.empty() && std::find(devices.begin(), devices.end(), one.device) == devices.end()) {
            devices.push_back(one.device);
        }
    }
    ordered_json grids = ordered_json::array(), plots = ordered_json::array();
    for (const Grid& grid : file.grids) {
        grids.push_back(grid_json(grid, placed));
    }
    for (const PlotRequest& plot : file.plots) {
        ordered_json where = ordered_json::object();
        for (const auto& [axis, value] : plot.where) {
            where[axis] = value;
        }
        plots.push_back({{"title", plot.title},
                         {"grid", plot.grid},
                         {"x", plot.x},
                         {"y", plot.y},
                         {"by", plot.by},
                         {"where", where}});
    }
    ordered_json json{{"name", title.name},        {"title", file.title},  {"paragraph", file.paragraph},
                      {"citation", file.citation}, {"quick", title.quick}, {"version", title.version},
                      {"devices", devices},        {"grids", grids},       {"plots", plots}};
    if (file.limits) {
        json["limits"] = limits_json(*file.limits, placed);
    }
    return json;
}

std::string csv_of(const std::vector<PlacedRun>& placed) {
    std::vector<std::string> axes, figures;
    const auto note = [](std::vector<std::string>& names, const std::string& name) {
        if (std::find(names.begin(), names.end(), name) == names.end()) {
            names.push_back(name);
        }
    };
    for (const PlacedRun& one : placed) {
        for (const auto& [axis, value] : one.run.at) {
            note(axes, axis);
        }
        for (const auto& [name, value] : one.figures) {
            note(figures, name);
        }
    }
    // A head, then a line a run.
    std::vector<std::string> head{"grid"};
    head.insert(head.end(), axes.begin(), axes.end());
    head.insert(head.end(), {"scene", "recipe", "width", "height", "status", "reason"});
    head.insert(head.end(), figures.begin(), figures.end());
    std::string text = csv_line(head);
    for (const PlacedRun& one : placed) {
        std::vector<std::string> line{one.run.grid};
        for (const std::string& axis : axes) {
            const auto at =
                std::find_if(one.run.at.begin(), one.run.at.end(), [&](const auto& p) { return p.first == axis; });
            line.push_back(at == one.run.at.end() ? "" : at->second);
        }
        line.insert(line.end(), {one.run.scene, one.run.recipe, fmt::format("{}", one.run.width),
                                 fmt::format("{}", one.run.height), one.status, one.reason});
        for (const std::string& name : figures) {
            const auto value = one.figure(name);
            line.push_back(value ? fmt::format("{}", *value) : "");
        }
        text += csv_line(line);
    }
    return text;
}

}  // namespace

void check_sweep_page(const std::filesystem::path& folder) {
    check_report(folder);
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code) {
        throw InputError(fmt::format("--report {}: the folder cannot be made: {}", folder.string(), code.message()));
    }
}

void write_sweep_page(const std::filesystem::path& folder, SweepStore& store) {
    const SweepTitle title = store.title();
    const SweepFile file = parse_sweep(title.text, title.name, title.quick);
    const std::vector<PlacedRun> placed = placed_runs(file, title.name, store);
    const std::filesystem::path templates = data_root() / "apps" / "report";
    std::string page = read_text(templates / "sweep.html");
    fill_in(page, "style", read_text(templates / "report.css"));
    fill_in(page, "charts", read_text(templates / "elements.js") + read_text(templates / "charts.js"));
    fill_in(page, "script", read_text(templates / "sweep.js"));
    fill_in(page, "data", for_script_element(dump(page_json(title, file, placed), -1)));
    write_text(folder / "index.html", page);
    write_text(folder / "runs.csv", csv_of(placed));
}

}  // namespace gn
