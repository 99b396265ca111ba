// SPDX-License-Identifier: MIT
// A recipe's passes on one view, timed and counted, and what each waits for.
#pragma once

#include "apps/compare/result.h"
#include "apps/evaluation/bottleneck.h"
#include "shadow/frame/frame.h"

namespace gn {

/// Passes of one name and group: rounds of a loop, and lights that are drawn alike, are one.
struct BenchedPass {
    std::string name, group;
    int times = 1;  ///< so many in a frame
    PassWork work;
    Verdict verdict;
};

/// One recipe on the view. Times are the least of the repeats.
struct BenchedRun {
    std::string recipe;
    Status status = Status::ok;
    std::string reason;                  ///< of a refusal, of all lights or of some
    double shadow_ms = 0, frame_ms = 0;  ///< sums over the passes
    Unit shadow = Unit::unknown, frame = Unit::unknown;
    std::vector<BenchedPass> passes;
};

/// Draws the view once with counters and `repeat` times with clocks. Throws Error.
BenchedRun bench_recipe(SceneGpu& scene, const Camera& camera, const PreparedRecipe& recipe, uvec2 size, int repeat,
                        const MachineRates& machine);

}  // namespace gn
