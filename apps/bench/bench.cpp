// SPDX-License-Identifier: MIT
// gnomon bench: what each pass of a frame waits for on this machine.
#include "apps/bench/print.h"
#include "apps/bench/probes.h"
#include "apps/choose.h"
#include "apps/notes.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/terminal.h"
#include "gpu/pass_counters.h"

#include <nlohmann/json.hpp>

#include <new>

namespace gn {
namespace {

std::vector<Recipe> recipes_of(const std::vector<std::string>& texts) {
    std::vector<Recipe> recipes;
    for (const std::string& text : texts) {
        try {
            recipes.push_back(load_recipe(text));
        } catch (const Error& error) {
            throw InputError(fmt::format("-r {}: {}", text, error.what()));
        }
    }
    return recipes;
}

/// A recipe's passes; what goes wrong becomes a failed run.
BenchedRun benched(SceneGpu& gpu, const Camera& camera, const Recipe& recipe, Device& device,
                   const BenchOptions& options, const MachineRates& machine) {
    try {
        return bench_recipe(gpu, camera, PreparedRecipe(device, recipe), uvec2(options.size.width, options.size.height),
                            options.repeat, machine);
    } catch (const std::bad_alloc&) {
        BenchedRun run;
        run.status = Status::failed;
        run.reason = "out of memory; a smaller --size, resolution or scene needs less";
        return run;
    } catch (const Error& error) {
        BenchedRun run;
        run.status = Status::failed;
        run.reason = error.what();
        return run;
    }
}

}  // namespace

int run(const BenchOptions& options) {
    // Everything that the user may have got wrong is found before the first pass.
    const std::vector<Recipe> recipes = recipes_of(options.recipes);
    const Scene scene = reading([&] { return load_asked(options.scene, options.file, options.size).scene; });
    const Camera camera = reading([&] { return scene.camera(options.view); });
    if (options.json != "-") {
        check_writable_parent("--json", options.json);
    }
    say_notes(options.scene, scene.notes);
    set_device_threads(options.threads);
    watch_signals();

    // What the machine can do.
    const std::unique_ptr<Device> device = Device::create({});
    say_notes("device", device->info().notes);
    Progress progress;
    const int steps = static_cast<int>(recipes.size()) + 1;
    progress.step(0, steps, "probing the machine");
    BenchResult result;
    result.device = device->info();
    result.uncounted = PassCounters(*device).missing();
    result.machine = probe_machine(*device);
    result.scene = options.scene;
    result.view = camera.name;
    result.width = options.size.width;
    result.height = options.size.height;
    result.repeat = options.repeat;
    progress.clear();
    const bool text = options.json != "-";
    fmt::print("{}", text ? machine_text(result) : "");

    // What each recipe's passes do with it.
    SceneGpu gpu = upload_scene(*device, scene);
    int status = exit_done;
    for (std::size_t r = 0; r < recipes.size() && !stop_requested(); ++r) {
        progress.step(static_cast<int>(r) + 1, steps, options.recipes[r]);
        BenchedRun run = benched(gpu, camera, recipes[r], *device, options, result.machine);
        run.recipe = options.recipes[r];
        progress.clear();
        fmt::print("{}", text ? run_text(run) : "");
        const bool bad = run.status == Status::failed || (options.strict && !run.reason.empty());
        status = bad ? exit_failed : status;
        if (!text && run.status != Status::ok) {
            fmt::print(stderr, "gnomon: {} {}: {}\n", run.recipe, name_of(run.status), run.reason);
        }
        result.runs.push_back(std::move(run));
    }
    if (stop_requested()) {
        fmt::print(stderr, "gnomon: stopped; {} recipes are measured\n", result.runs.size());
        status = exit_failed;
    }
    if (options.json == "-") {
        fmt::print("{}\n", dump(bench_json(result), 2));
    } else if (!options.json.empty()) {
        write_text(options.json, dump(bench_json(result), 2) + "\n");
    }
    return status;
}

}  // namespace gn
