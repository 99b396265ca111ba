// SPDX-License-Identifier: MIT
#include "apps/compare/publish.h"

#include "apps/compare/pictures.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/terminal.h"
#include "base/paths.h"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>

namespace gn {
namespace {

namespace fs = std::filesystem;

/// "ok", or "ok, 2 of 3 lights" when some were refused.
std::string status_of(const RunResult& run) {
    const auto served =
        std::count_if(run.lights.begin(), run.lights.end(), [](const auto& l) { return l.status == Status::ok; });
    const bool all = served == static_cast<std::ptrdiff_t>(run.lights.size());
    return run.status != Status::ok || all ? std::string(name_of(run.status))
                                           : fmt::format("ok, {} of {} lights", served, run.lights.size());
}

std::string milliseconds(std::optional<double> value) {
    return value ? fmt::format("{:.2f}", *value) : "-";
}

}  // namespace

void fill_in(std::string& text, const std::string& name, const std::string& value) {
    const std::string mark = "{{" + name + "}}";
    const std::size_t at = text.find(mark);
    GN_CHECK(at != std::string::npos);
    text.replace(at, mark.size(), value);
}

std::string for_script_element(std::string json) {
    for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at + 1)) {
        json.replace(at, 1, "\\u003c");
    }
    return json;
}

void check_report(const fs::path& folder) {
    // The nearest folder that is there decides.
    std::error_code code;
    fs::path there = fs::absolute(folder, code).lexically_normal();
    while (!fs::exists(there, code) && there.has_relative_path()) {
        there = there.parent_path();
    }
    if (!fs::is_directory(there, code) || access(there.c_str(), W_OK | X_OK) != 0) {
        throw InputError(
            fmt::format("-o {}: the folder cannot be made or written to: {} is no folder that can be written to",
                        folder.string(), there.string()));
    }
}

void prepare_report(const fs::path& folder) {
    std::error_code code;
    for (const char* inside : {"pictures", "results"}) {
        fs::create_directories(folder / inside, code);
        if (code || access((folder / inside).c_str(), W_OK) != 0) {
            throw InputError(fmt::format("-o {}: the folder cannot be made or written to{}{}", folder.string(),
                                         code ? ": " : "", code ? code.message() : ""));
        }
    }
    write_png(folder / "pictures" / "error-scale.png", error_scale());
}

void write_report(const fs::path& folder, const Comparison& comparison) {
    const fs::path templates = data_root() / "apps" / "report";
    std::string page = read_text(templates / "index.html");
    fill_in(page, "style", read_text(templates / "report.css"));
    fill_in(page, "script", read_text(templates / "elements.js") + read_text(templates / "report.js"));
    fill_in(page, "data", for_script_element(dump(report_json(comparison), -1)));
    write_text(folder / "index.html", page);
}

std::string summary_table(const Comparison& comparison) {
    std::vector<std::string> header{"scene", "recipe",   "status", "rmse",      "mismatch", "leak",
                                    "acne",  "penumbra", "flip",   "shadow ms", "frame ms", "memory"};
    // Columns for flicker and the error along the path only where a path was followed.
    const bool path = std::any_of(comparison.runs.begin(), comparison.runs.end(),
                                  [](const RunResult& run) { return !run.path.empty(); });
    if (path) {
        header.insert(header.begin() + 9, {"flicker", "path rmse"});
    }
    // Likewise for what another recipe was held against.
    const std::ptrdiff_t against = !comparison.against.empty() ? (path ? 11 : 9) : 0;
    if (against > 0) {
        header.insert(header.begin() + against, "against");
    }
    std::vector<std::vector<std::string>> rows;
    for (const RunResult& run : comparison.runs) {
        const Errors& e = run.errors;
        rows.push_back({run.scene, run.overrides.empty() ? run.recipe : run.recipe + "," + run.overrides,
                        status_of(run), figure(e.rmse), figure(e.mismatch), figure(e.leak), figure(e.acne),
                        figure(e.penumbra), figure(e.flip), milliseconds(run.shadow.median),
                        milliseconds(run.frame.median), run.status == Status::ok ? human_bytes(run.bytes) : "-"});
        if (path) {
            rows.back().insert(rows.back().begin() + 9, {figure(e.flicker), figure(e.path_rmse)});
        }
        if (against > 0) {
            rows.back().insert(rows.back().begin() + against, figure(e.against));
        }
    }
    return text_table(header, rows, 3);
}

}  // namespace gn
