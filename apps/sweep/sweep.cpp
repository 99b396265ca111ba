// SPDX-License-Identifier: MIT
// gnomon sweep: every run of a grid that is not finished yet, each on the disk before the next begins; gnomon merge.
#include "apps/choose.h"
#include "apps/compare/measure.h"
#include "apps/evaluation/sweep_store.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/sweep/page.h"
#include "apps/sweep/sweeps.h"

#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <new>
#include <set>

namespace gn {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

CompareOptions options_of(const SweepRun& run, const SweepOptions& asked) {
    CompareOptions options;
    options.size = {run.width, run.height};
    options.view = run.view;
    options.light = run.light;
    options.samples = run.samples;
    options.repeat = run.repeat;
    options.threads = asked.threads;
    options.validate = asked.validate;
    options.shaded = run.shaded;
    return options;
}

/// The runs of one share, one view after the other.
class Sweeper {
  public:
    Sweeper(const SweepOptions& options, SweepStore& store, std::vector<SweepRun> runs)
        : options_(options), store_(store), runs_(std::move(runs)), bench_(options.validate) {
        device_ = fmt::format("{} ({})", bench_.device().info().name, bench_.device().info().driver);
        for (const auto& [key, status] : store_.statuses()) {
            // What was absent may have come since; what failed is asked for again by --again alone.
            if (status != "absent" && !(status == "failed" && options.again)) {
                finished_.insert(key);
            }
        }
        rows_ = store_.rows();
        std::erase_if(rows_, [&](const SweepRow& row) { return finished_.count(row.key) == 0; });
    }

    int run() {
        last_ = said_ = Clock::now();
        for (const SweepRun& run : runs_) {
            if (stop_requested() || abandoned_ || (options_.limit > 0 && measured_ >= options_.limit)) {
                break;
            }
            if (finished_.count(run.key) == 0) {
                measure_one(run);
            }
        }
        view_.reset();
        progress_.clear();
        return finish();
    }

  private:
    void measure_one(const SweepRun& run) {
        say_progress(run);
        SweepRow row{run.key, fingerprint_of(run.view_text()), "absent", "", "", 0, device_};
        std::optional<AskedRecipe> asked;
        try {
            asked = AskedRecipe{run.recipe, load_recipe(run.recipe)};
        } catch (const Error& error) {
            row.reason = error.what();
        }
        if (asked) {
            RunResult result;
            try {
                result = measured(run, *asked);
            } catch (const Stopped&) {
                return;
            }
            row.status = name_of(result.status);
            row.reason = result.reason;
            row.document = dump(run_json(result, false), -1);
        }
        row.seconds = seconds_since(last_);
        last_ = Clock::now();
        store_.add(row);
        finished_.insert(row.key);
        ++measured_;
        ++counts_[row.status];
        if (row.status == "absent" || row.status == "failed") {
            say_trouble(run, row);
        }
        rows_.push_back(std::move(row));
    }

    /// A recipe's figures; what goes wrong becomes a failed run. Throws Stopped.
    RunResult measured(const SweepRun& run, const AskedRecipe& asked) {
        std::string sentence;
        try {
            if (!view_ || view_text_ != run.view_text()) {
                open(run);
            }
            view_->prepare(bench_, *cache_, progress_);
            return measure(*view_, bench_, asked, run.key, *compare_);
        } catch (const std::bad_alloc&) {
            sentence = "out of memory; a smaller size, resolution or scene needs less";
        } catch (const std::exception& error) {
            sentence = error.what();
        }
        RunResult failed = describe_run(run.scene, asked, options_of(run, options_));
        failed.status = Status::failed;
        failed.reason = sentence;
        recover();
        return failed;
    }

    void open(const SweepRun& run) {
        view_.reset();
        view_text_ = run.view_text();
        compare_ = options_of(run, options_);
        cache_.emplace("", false, *compare_, bench_.device().info());
        view_.emplace(run.scene, *compare_, nullptr);
        view_->name_in(*cache_);
    }

    /// After a failure the device may be lost, and a view half prepared.
    void recover() {
        view_.reset();
        if (!bench_.alive()) {
            try {
                bench_.replace();
            } catch (const std::exception& error) {
                abandoned_ = true;
                progress_.clear();
                fmt::print(stderr, "gnomon: the device is lost: {}\n", error.what());
            }
        }
    }

    std::string time_left() {
        const Estimate rest = estimate(rows_, runs_);
        return rest.seconds ? fmt::format("about {} left", spoken_time(*rest.seconds)) : "no estimate yet";
    }

    void say_progress(const SweepRun& run) {
        const int done = static_cast<int>(std::count_if(
            runs_.begin(), runs_.end(), [&](const SweepRun& other) { return finished_.count(other.key) != 0; }));
        const int all = static_cast<int>(runs_.size());
        // Without a terminal, as under a job scheduler, a line a minute.
        if (!progress_.terminal() && seconds_since(said_) > 60) {
            fmt::print(stderr, "gnomon: {} of {} runs, {}\n", done, all, time_left());
            said_ = Clock::now();
        }
        if (progress_.terminal()) {
            progress_.step(done, all,
                           fmt::format("{} of {}, {}: {} {}", done, all, time_left(), run.scene, run.recipe));
        }
    }

    /// Once a recipe and reason: an absent part would else be said a thousand times.
    void say_trouble(const SweepRun& run, const SweepRow& row) {
        if (said_reasons_.insert(row.status + row.reason).second) {
            progress_.clear();
            fmt::print(stderr, "gnomon: {} with {} {}: {}\n", run.scene, run.recipe, row.status, row.reason);
        }
    }

    int finish() {
        std::string counts;
        for (const auto& [status, count] : counts_) {
            counts += fmt::format(", {} {}", count, status);
        }
        const Estimate rest = estimate(rows_, runs_);
        fmt::print("{}: {} runs measured now{}; {} of {} finished{}\n", store_.path().string(), measured_, counts,
                   rest.finished, rest.finished + rest.left,
                   rest.left > 0 ? ", " + time_left() + "; the same command goes on" : "");
        if (stop_requested()) {
            fmt::print(stderr, "gnomon: stopped; what is finished is kept\n");
        }
        return stop_requested() || abandoned_ || counts_.count("failed") != 0 ? exit_failed : exit_done;
    }

    const SweepOptions& options_;
    SweepStore& store_;
    std::vector<SweepRun> runs_;
    Bench bench_;
    Progress progress_;
    std::string device_;
    std::optional<CompareOptions> compare_;
    std::optional<ResultCache> cache_;
    std::optional<ViewSession> view_;
    std::string view_text_;
    std::set<std::string> finished_, said_reasons_;
    std::vector<SweepRow> rows_;
    std::map<std::string, int> counts_;
    int measured_ = 0;
    Clock::time_point last_, said_;
    bool abandoned_ = false;
};

/// Names of recipes that cannot be read, each with its sentence: what is not there yet is said before anything is measured.
std::map<std::string, std::string> absent_recipes(const std::vector<SweepRun>& runs) {
    std::map<std::string, std::string> absent;
    std::set<std::string> seen;
    for (const SweepRun& run : runs) {
        if (!seen.insert(run.recipe).second) {
            continue;
        }
        try {
            load_recipe(run.recipe);
        } catch (const Error& error) {
            absent.emplace(run.recipe, error.what());
        }
    }
    return absent;
}

/// --plan: what there is to do, and what it will take.
void say_plan(const SweepFile& file, const std::vector<SweepRun>& runs, const SweepOptions& options,
              const std::vector<SweepRow>& rows) {
    std::map<std::string, int> grids;
    std::set<std::string> views, keys;
    for (const SweepRun& run : runs) {
        ++grids[run.grid];
        views.insert(run.view_text());
        keys.insert(run.key);
    }
    fmt::print("{}\n{} runs on {} views{}\n", file.title, keys.size(), views.size(),
               options.shard.empty() ? "" : ", part " + options.shard);
    for (const Grid& grid : file.grids) {
        std::string axes;
        for (const Axis& axis : grid.axes) {
            axes += fmt::format("{}{} {}", axes.empty() ? "" : " x ", axis.values.size(), axis.name);
        }
        fmt::print("  {}: {} runs, {}\n", grid.name, grids[grid.name], axes.empty() ? "one run" : axes);
    }
    for (const auto& [recipe, sentence] : absent_recipes(runs)) {
        fmt::print("  absent: {}: {}\n", recipe, sentence);
    }
    const Estimate rest = estimate(rows, runs);
    fmt::print("{} finished, {} left\n", rest.finished, rest.left);
    if (rest.seconds) {
        fmt::print("about {}{} left on this machine, {:.2f} hours\n", spoken_time(*rest.seconds),
                   rest.deviation ? " +- " + spoken_time(*rest.deviation) : "", *rest.seconds / 3600);
        fmt::print("about {} in the file when all is done\n",
                   human_bytes(static_cast<std::uint64_t>(rest.bytes.value_or(0))));
    } else {
        fmt::print(
            "hours and bytes are foretold from what is finished; --limit 30 measures thirty that are spread over "
            "all\n");
    }
}

std::optional<SweepStore> store_if_there(const std::string& path) {
    std::error_code code;
    return std::filesystem::exists(path, code) ? std::optional<SweepStore>(std::in_place, path) : std::nullopt;
}

std::string default_output(const NamedSweep& sweep, const SweepOptions& options) {
    std::string part = options.shard;
    std::replace(part.begin(), part.end(), '/', '-');
    return sweep.title.name + (options.quick ? "-quick" : "") + (part.empty() ? "" : "-" + part) + ".sqlite";
}

}  // namespace

int run(const SweepOptions& asked) {
    // Read everything that can be wrong before the first frame.
    SweepOptions options = asked;
    const NamedSweep sweep = reading([&] { return find_sweep(options.file, options.quick); });
    const SweepFile file = reading([&] { return parse_sweep(sweep.title.text, sweep.where, options.quick); });
    const std::vector<SweepRun> all = reading([&] { return expand(file, sweep.where); });
    const Shard shard = options.shard.empty() ? Shard{} : reading([&] { return parse_shard(options.shard); });
    const std::vector<SweepRun> runs = share_of(all, shard);
    if (options.output.empty()) {
        options.output = default_output(sweep, options);
    }
    check_writable_parent("-o", options.output);
    if (options.plan) {
        auto store = reading([&] { return store_if_there(options.output); });
        say_plan(file, runs, options, store ? store->rows() : std::vector<SweepRow>{});
        return exit_done;
    }
    if (!options.report.empty()) {
        check_sweep_page(options.report);
    }
    set_device_threads(options.threads);
    // Measure, then show.
    watch_signals();
    SweepStore store = reading([&] { return SweepStore(options.output, sweep.title); });
    const int status = options.show_only ? exit_done : Sweeper(options, store, runs).run();
    if (!options.report.empty()) {
        write_sweep_page(options.report, store);
        fmt::print("report: {}/index.html\n", options.report);
    }
    return status;
}

int run(const MergeOptions& options) {
    std::vector<std::filesystem::path> inputs(options.inputs.begin(), options.inputs.end());
    check_writable_parent("-o", options.output);
    const Merged merged = reading([&] { return merge_stores(inputs, options.output); });
    fmt::print("{}: {} runs of {} files{}\n", options.output, merged.rows, inputs.size(),
               merged.doubled > 0
                   ? fmt::format(", {} of which stood in several and are taken from the first", merged.doubled)
                   : "");
    if (!options.report.empty()) {
        check_sweep_page(options.report);
        SweepStore store(options.output);
        write_sweep_page(options.report, store);
        fmt::print("report: {}/index.html\n", options.report);
    }
    return exit_done;
}

}  // namespace gn
