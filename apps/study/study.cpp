// SPDX-License-Identifier: MIT
// gnomon study: prepare a study's pictures, serve it, export and analyse its answers.
#include "apps/evaluation/study_analysis.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/study/prepare.h"
#include "apps/study/serve.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace gn {
namespace {

/// Results, as JSON where asked for.
int analyse(const StudyOptions& options, const StudyPlan& plan, StudyStore& store) {
    const nlohmann::ordered_json results = study_results(plan, store);
    const std::string text = results.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    if (options.json == "-") {
        fmt::print("{}", text);
        return exit_done;
    }
    if (!options.json.empty()) {
        write_text(options.json, text);
    }
    fmt::print("{}", study_text(results));
    return exit_done;
}

int export_answers(const StudyOptions& options, const StudyPlan& plan, StudyStore& store) {
    const std::string text = study_csv(plan, store);
    if (options.output.empty() || options.output == "-") {
        fmt::print("{}", text);
    } else {
        write_text(options.output, text);
    }
    return exit_done;
}

}  // namespace

int run(const StudyOptions& options) {
    if (options.action == "prepare") {
        return prepare_study(options);
    }
    if (options.json != "-") {
        check_writable_parent("--json", options.json);
    }
    if (options.output != "-") {
        check_writable_parent("-o", options.output);
    }
    const StudyPlan plan = reading([&] { return read_plan(options.folder); });
    if (options.action == "serve") {
        return serve_study(options);
    }
    StudyStore store = reading([&] { return StudyStore(std::filesystem::path(options.folder) / "answers.sqlite"); });
    return options.action == "export" ? export_answers(options, plan, store) : analyse(options, plan, store);
}

}  // namespace gn
