// SPDX-License-Identifier: MIT
#include "apps/study/prepare.h"

#include "apps/compare/measure.h"
#include "apps/compare/publish.h"
#include "apps/evaluation/study_plan.h"
#include "apps/output.h"
#include "apps/sweep/sweeps.h"

#include <algorithm>

namespace gn {
namespace {

namespace fs = std::filesystem;

/// Views in the file's order, each with its runs.
std::vector<std::vector<SweepRun>> views_of(const std::vector<SweepRun>& runs) {
    std::vector<std::vector<SweepRun>> views;
    for (const SweepRun& run : runs) {
        if (views.empty() || views.back().front().view_text() != run.view_text()) {
            views.emplace_back();
        }
        views.back().push_back(run);
    }
    return views;
}

/// What a run is called among the others of its view: the value of the axis that tells them apart.
std::string name_of_run(const SweepRun& run, const std::vector<SweepRun>& view) {
    std::string name;
    for (std::size_t a = 0; a < run.at.size(); ++a) {
        const bool same =
            std::all_of(view.begin(), view.end(), [&](const SweepRun& other) { return other.at[a] == run.at[a]; });
        if (!same) {
            name += (name.empty() ? "" : ", ") + run.at[a].second;
        }
    }
    return name.empty() ? run.recipe : name;
}

std::string name_of_view(const SweepRun& run, const std::vector<SweepRun>& view) {
    std::string name;
    for (std::size_t a = 0; a < run.at.size(); ++a) {
        const bool same =
            std::all_of(view.begin(), view.end(), [&](const SweepRun& other) { return other.at[a] == run.at[a]; });
        if (same) {
            name += (name.empty() ? "" : ", ") + run.at[a].second;
        }
    }
    return name.empty() ? run.scene : name;
}

/// Draws the pictures of one view; "reference" is the traced one.
SurveyPage draw_page(const std::vector<SweepRun>& view, const fs::path& folder, Bench& bench, Progress& progress) {
    const SweepRun& first = view.front();
    CompareOptions options;
    options.size = {first.width, first.height};
    options.view = first.view;
    options.light = first.light;
    options.samples = first.samples;
    options.repeat = 1;
    options.folder = folder;
    const ResultCache cache(folder, false, options, bench.device().info());
    ViewSession session(first.scene, options, nullptr);
    session.name_in(cache);
    session.prepare(bench, cache, progress);
    SurveyPage page{name_of_view(first, view), {}};
    for (const SweepRun& run : view) {
        const AskedRecipe asked{run.recipe, reading([&] { return load_recipe(run.recipe); })};
        const std::string key = cache.run_key(session.key(), asked.recipe, nullptr);
        const RunResult result = measure(session, bench, asked, key, options);
        if (result.status != Status::ok) {
            fail("{} with {} {}: {}; a survey needs all of its pictures", run.scene, run.recipe, name_of(result.status),
                 result.reason);
        }
        page.pictures.push_back({name_of_run(run, view), result.picture});
    }
    page.pictures.push_back({"reference", session.result.reference.picture});
    return page;
}

StudyPlan drawn_survey(const StudyOptions& options) {
    const NamedSweep sweep = reading([&] { return find_sweep(options.sweep, options.quick); });
    const std::vector<SweepRun> runs =
        reading([&] { return expand(parse_sweep(sweep.title.text, sweep.where, options.quick), sweep.where); });
    const auto views = views_of(runs);
    for (const auto& view : views) {
        if (view.size() < 1 || view.size() > 8) {
            throw InputError(
                fmt::format("{}: a view has {} recipes; a page ranks one to eight of them and the reference",
                            sweep.where, view.size()));
        }
    }
    prepare_report(options.folder);
    Bench bench(false);
    Progress progress;
    StudyPlan plan;
    for (std::size_t v = 0; v < views.size(); ++v) {
        if (stop_requested()) {
            fail("stopped; the same command goes on with the traced references that are kept");
        }
        progress.step(static_cast<int>(v), static_cast<int>(views.size()), views[v].front().scene);
        plan.pages.push_back(draw_page(views[v], options.folder, bench, progress));
    }
    return plan;
}

}  // namespace

int prepare_study(const StudyOptions& options) {
    const fs::path folder = options.folder, plan_file = folder / "study.json";
    std::error_code code;
    if (fs::exists(plan_file, code)) {
        throw InputError(fmt::format("{}: is prepared already; answers belong to what was shown", folder.string()));
    }
    check_report(folder);
    watch_signals();
    StudyPlan plan;
    if (options.kind == "threshold") {
        // [Kre17] section 4.3: a texel of 5, 10 and 20 pixels, at full and half contrast.
        plan.kind = StudyKind::threshold;
        plan.artifacts = {5, 10, 20};
        plan.contrasts = {1, 0.5};
        fs::create_directories(folder, code);
    } else {
        try {
            plan = drawn_survey(options);
        } catch (const Stopped&) {
            fail("stopped; the same command goes on with the traced references that are kept");
        }
    }
    write_text(plan_file, plan_text(plan));
    fmt::print("{}: {} is ready; 'gnomon study serve {}' opens it\n", folder.string(), options.kind,
               shell_word(folder.string()));
    return exit_done;
}

}  // namespace gn
