// SPDX-License-Identifier: MIT
// gnomon compare: every recipe on every scene; each finished run is written at once.
#include "apps/choose.h"
#include "apps/compare/measure.h"
#include "apps/compare/publish.h"
#include "apps/notes.h"
#include "apps/options.h"
#include "apps/output.h"

#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <new>
#include <set>

namespace gn {
namespace {

template <class T>
std::vector<T> without_repeats(const std::vector<T>& items) {
    std::vector<T> unique;
    for (const T& item : items) {
        if (std::find(unique.begin(), unique.end(), item) == unique.end()) {
            unique.push_back(item);
        }
    }
    return unique;
}

/// Finds misspelt scenes before an hour of work on the others.
void check_scene_exists(const std::string& asked) {
    const std::string name = asked.substr(0, asked.find(':'));
    const auto& known = builtin_scenes();
    const bool builtin = std::any_of(known.begin(), known.end(), [&](const BuiltinScene& s) { return s.name == name; });
    std::error_code code;
    if (!builtin && !std::filesystem::exists(asked, code)) {
        load_scene(asked);
    }
}

/// The recipe of an option -r or --against.
AskedRecipe read_recipe(const std::string& option, const std::string& text) {
    try {
        return {text, load_recipe(text)};
    } catch (const Error& error) {
        // Everything between -r and the next option is a recipe: say so to whom wrote a scene there.
        const auto& known = builtin_scenes();
        if (std::any_of(known.begin(), known.end(), [&](const BuiltinScene& s) { return s.name == text; })) {
            throw InputError(
                fmt::format("{}: '{}' is a scene, not a recipe; scenes stand before the first -r", option, text));
        }
        const std::string sentence = error.what();
        const bool named = sentence.starts_with("-r ");
        throw InputError(named ? option + sentence.substr(2) : fmt::format("{}: {}", option, sentence));
    }
}

class Comparer {
  public:
    /// `against` may be null.
    Comparer(const CompareOptions& options, const Recipe* against)
        : options_(options),
          against_(against),
          bench_(options.validate),
          cache_(options.folder, options.fresh, options, bench_.device().info()) {
        say_notes("device", bench_.device().info().notes);
        comparison_.device = bench_.device().info();
        comparison_.command = options.command;
        comparison_.against = options.against;
        comparison_.samples = options.samples;
        comparison_.repeat = options.repeat;
    }

    int run(const std::vector<AskedRecipe>& recipes) {
        const int steps = static_cast<int>(options_.scenes.size() * (recipes.size() + 1));
        int step = 0;
        for (const std::string& scene : options_.scenes) {
            compare_scene(scene, recipes, step, steps);
            step += static_cast<int>(recipes.size() + 1);
        }
        progress_.clear();
        finish();
        return status_;
    }

  private:
    void compare_scene(const std::string& asked, const std::vector<AskedRecipe>& recipes, int step, int steps) {
        if (stopping()) {
            return;
        }
        progress_.step(step, steps, "reading " + asked);
        std::optional<ViewSession> view;
        if (const std::string sentence = failure_of([&] { open(view, asked); }); !sentence.empty()) {
            fail_scene(asked, recipes, sentence);
            return;
        }
        // Now there is something to report: until here nothing was touched that an earlier comparison left.
        prepare_folder();
        const std::size_t index = comparison_.scenes.size();
        comparison_.scenes.push_back(view->result);
        for (std::size_t r = 0; r < recipes.size() && !stopping(); ++r) {
            const int at = step + 1 + static_cast<int>(r);
            if (!add_run(*view, recipes[r], at, steps)) {
                return;
            }
            comparison_.scenes[index].reference = view->result.reference;
            publish();
        }
    }

    void open(std::optional<ViewSession>& view, const std::string& asked) {
        view.emplace(asked, options_, against_);
        view->name_in(cache_);
        progress_.clear();
        say_notes(asked, view->scene().notes);
    }

    void prepare_folder() {
        if (!prepared_ && !options_.folder.empty()) {
            prepare_report(options_.folder);
        }
        prepared_ = true;
    }

    /// Adds the run, from the cache or measured; false when the user asked to stop before it was complete.
    bool add_run(ViewSession& view, const AskedRecipe& asked, int step, int steps) {
        const std::string key = cache_.run_key(view.key(), asked.recipe, against_);
        if (auto known = cache_.find_run(key); known && view.result.reference.samples > 0) {
            spdlog::info("{} with {}: taken from an earlier run", view.result.scene, asked.text);
            take(std::move(*known));
            return true;
        }
        // Trace what is missing, then measure; what fails becomes a failed run.
        RunResult run;
        std::string sentence;
        try {
            sentence = failure_of([&] {
                progress_.step(step - 1, steps, fmt::format("{}: tracing the truth", view.result.scene));
                view.prepare(bench_, cache_, progress_);
                progress_.step(step, steps, fmt::format("{}: {}", view.result.scene, asked.text));
                run = measure(view, bench_, asked, key, options_);
            });
        } catch (const Stopped&) {
            return false;
        }
        if (!sentence.empty()) {
            run = failed_run(view.result.scene, asked, sentence);
            recover(view);
        }
        if (run.status == Status::ok || run.status == Status::empty) {
            cache_.store(key, run);
        }
        take(std::move(run));
        return true;
    }

    /// The sentence of what went wrong in `body`, or "". Remembers which exit status it means.
    template <class Body>
    std::string failure_of(const Body& body) {
        try {
            body();
            return {};
        } catch (const InputError& error) {
            status_ = exit_input;
            return error.what();
        } catch (const std::bad_alloc&) {
            worsen(exit_failed);
            return "out of memory; a smaller --size, resolution or scene needs less";
        } catch (const std::exception& error) {
            worsen(exit_failed);
            return error.what();
        }
    }

    void worsen(int status) { status_ = std::max(status_, status); }

    RunResult failed_run(const std::string& scene, const AskedRecipe& asked, const std::string& sentence) {
        RunResult run = describe_run(scene, asked, options_);
        run.status = Status::failed;
        run.reason = sentence;
        return run;
    }

    void fail_scene(const std::string& asked, const std::vector<AskedRecipe>& recipes, const std::string& sentence) {
        progress_.clear();
        fmt::print(stderr, "gnomon: {}\n", sentence);
        SceneResult scene;
        scene.scene = scene.name = asked;
        scene.view = options_.view;
        scene.width = options_.size.width;
        scene.height = options_.size.height;
        comparison_.scenes.push_back(scene);
        for (const AskedRecipe& recipe : recipes) {
            comparison_.runs.push_back(failed_run(asked, recipe, sentence));
        }
        publish();
    }

    /// After a failure the device may be lost: the next run then gets a new one.
    void recover(ViewSession& view) {
        if (!bench_.alive()) {
            view.release_device();
            const std::string sentence = failure_of([&] { bench_.replace(); });
            abandoned_ = !sentence.empty();
            fmt::print(stderr, "{}", abandoned_ ? fmt::format("gnomon: the device is lost: {}\n", sentence) : "");
        }
    }

    void take(RunResult run) {
        progress_.clear();
        const std::string of = fmt::format("{} with {}", run.scene, run.recipe);
        // A run that left lights out is ok, but nobody should have to find that out from the figures.
        const bool light_refused = run.status == Status::ok && say_lights(run, of);
        for (const std::string& remark : run.remarks) {
            say_once(of, run.scene, remark);
        }
        if (run.status == Status::failed) {
            worsen(exit_failed);
        }
        if (options_.strict && (run.status == Status::refused || run.status == Status::empty || light_refused)) {
            worsen(exit_failed);
        }
        if (run.status != Status::ok) {
            fmt::print(stderr, "gnomon: {} {}: {}\n", of, name_of(run.status), run.reason);
        }
        comparison_.runs.push_back(std::move(run));
    }

    /// Says which lights of a run have no figures, a line a reason; true when some were refused.
    bool say_lights(const RunResult& run, const std::string& of) {
        std::vector<LightReason> refused;
        std::vector<std::string> empty;
        for (const LightResult& light : run.lights) {
            if (light.status == Status::refused) {
                refused.emplace_back(light.name, light.reason);
            } else if (light.status == Status::empty) {
                empty.push_back(light.reason);
            }
        }
        for (const std::string& sentence : grouped_reasons(refused, " refused")) {
            fmt::print(stderr, "gnomon: {}: {}\n", of, sentence);
        }
        for (const std::string& sentence : grouped(empty)) {
            say_once(of, run.scene, sentence);
        }
        return !refused.empty();
    }

    /// What is true of a view whatever the recipe is said with the first of them.
    void say_once(const std::string& of, const std::string& scene, const std::string& note) {
        if (said_.insert(scene + "\n" + note).second) {
            say_notes(of, {&note, 1});
        }
    }

    [[nodiscard]] bool stopping() const { return abandoned_ || stop_requested(); }

    /// Writes report and figures, once there is a scene that could be read and a run to show.
    void publish() {
        if (!prepared_ || comparison_.runs.empty()) {
            return;
        }
        if (!options_.folder.empty()) {
            write_report(options_.folder, comparison_);
        }
        if (!options_.json.empty() && options_.json != "-") {
            write_text(options_.json, dump(contract_json(comparison_), 2) + "\n");
        }
    }

    void finish() {
        if (stop_requested()) {
            fmt::print(stderr, "gnomon: stopped; {} finished runs are kept\n", comparison_.runs.size());
            worsen(exit_failed);
        }
        publish();
        if (options_.json == "-") {
            fmt::print("{}\n", dump(contract_json(comparison_), 2));
            return;
        }
        if (!prepared_) {
            return;
        }
        fmt::print("{}", summary_table(comparison_));
        fmt::print("on {} ({})\n", comparison_.device.name, comparison_.device.driver);
        fmt::print("{}", options_.folder.empty() ? "" : fmt::format("report: {}/index.html\n", options_.folder));
    }

    CompareOptions options_;
    const Recipe* against_;
    Bench bench_;
    ResultCache cache_;
    Progress progress_;
    Comparison comparison_;
    std::set<std::string> said_;
    int status_ = exit_done;
    bool prepared_ = false;   ///< a scene was read, and the report's folder made
    bool abandoned_ = false;  ///< no device can be had any more
};

}  // namespace

int run(const CompareOptions& asked) {
    // Read everything that can be wrong before the first frame.
    CompareOptions options = asked;
    options.scenes = without_repeats(options.scenes);
    options.recipes = without_repeats(options.recipes);
    std::vector<AskedRecipe> recipes;
    for (const std::string& text : options.recipes) {
        recipes.push_back(read_recipe("-r", text));
    }
    std::optional<Recipe> against;
    if (!options.against.empty()) {
        against = read_recipe("--against", options.against).recipe;
    }
    for (const std::string& scene : options.scenes) {
        reading([&] { check_scene_exists(scene); });
    }
    if (options.json != "-") {
        check_writable_parent("--json", options.json);
    }
    if (!options.folder.empty()) {
        check_report(options.folder);
    }
    set_device_threads(options.threads);
    watch_signals();
    return Comparer(options, against ? &*against : nullptr).run(recipes);
}

}  // namespace gn
