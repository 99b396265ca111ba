// SPDX-License-Identifier: MIT
#include "apps/bench/measured.h"

#include "apps/notes.h"
#include "gpu/pass_counters.h"

#include <algorithm>

namespace gn {
namespace {

PassWork work_of(const CountedPass& counted, double ms) {
    PassWork work;
    work.ms = ms;
    work.draws = counted.draws;
    work.shades = counted.shades;
    if (counted.counts) {
        const PassCounts& c = *counted.counts;
        work.counts = PassWork::Counts{c.vertices, c.emitted, c.primitives, c.fragments, c.items};
    }
    work.samples = counted.samples;
    work.bytes = counted.bytes;
    return work;
}

/// Adds a pass to those of its name, or as the first of it.
void add(std::vector<BenchedPass>& passes, const CountedPass& counted, double ms) {
    const PassWork work = work_of(counted, ms);
    for (BenchedPass& known : passes) {
        if (known.name == counted.name && known.group == counted.group) {
            known.work += work;
            ++known.times;
            return;
        }
    }
    passes.push_back({.name = counted.name, .group = counted.group, .times = 1, .work = work, .verdict = {}});
}

/// Each pass by itself, then all of the shadow and all of the frame.
void judge(BenchedRun& run, const MachineRates& machine) {
    std::vector<JudgedPass> shadow, frame;
    for (BenchedPass& pass : run.passes) {
        MachineRates rates = machine;
        rates.pass *= pass.times;
        pass.verdict = bottleneck_of(pass.work, rates);
        frame.push_back({pass.verdict.unit, pass.work.ms});
        run.frame_ms += pass.work.ms;
        if (pass.group == "shadow") {
            shadow.push_back(frame.back());
            run.shadow_ms += pass.work.ms;
        }
    }
    run.shadow = bottleneck_of(shadow);
    run.frame = bottleneck_of(frame);
}

/// What was refused of the scene's lights; the run goes on where some were served.
void say_refusals(BenchedRun& run, const Scene& scene, const FrameResult& frame) {
    const std::vector<LightReason> refused = refused_lights(scene, frame);
    run.reason = refused.empty() ? "" : joined_reasons(refused);
    run.status = !refused.empty() && refused.size() == scene.lights.size() ? Status::refused : Status::ok;
}

}  // namespace

BenchedRun bench_recipe(SceneGpu& scene, const Camera& camera, const PreparedRecipe& recipe, uvec2 size, int repeat,
                        const MachineRates& machine) {
    const FrameOptions untimed{
        .width = size.x, .height = size.y, .repeat = 0, .samples = false, .visibility = false, .picture = true};
    BenchedRun run;
    std::vector<CountedPass> counted;
    {
        PassCounters counters(recipe.device());
        say_refusals(run, *scene.scene, render_frame(scene, camera, recipe, untimed));
        counted = counters.passes();
    }
    if (run.status == Status::refused) {
        return run;
    }
    FrameOptions timed = untimed;
    timed.repeat = repeat;
    const FrameResult frame = render_frame(scene, camera, recipe, timed);
    GN_CHECK(frame.pass_ms.size() == counted.size());
    for (std::size_t i = 0; i < counted.size(); ++i) {
        add(run.passes, counted[i], *std::min_element(frame.pass_ms[i].begin(), frame.pass_ms[i].end()));
    }
    judge(run, machine);
    return run;
}

}  // namespace gn
