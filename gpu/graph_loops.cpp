// SPDX-License-Identifier: MIT
// What a plan runs, in which order: passes round after round in loops, and none that rest.
#include "gpu/graph_plan.h"

#include <algorithm>

namespace gn {

Calls calls_of(const GraphDeclaration& declaration, std::uint32_t pass) {
    std::uint32_t before = 0;
    for (const DeclaredLoop& loop : declaration.loops) {
        if (pass >= loop.first && pass < loop.first + loop.count) {
            return {before + pass, loop.count, loop.rounds};
        }
        before += pass >= loop.first ? (loop.rounds - 1) * loop.count : 0;
    }
    return {before + pass};
}

void find_loops(const GraphDeclaration& declaration, GraphPlan& plan) {
    for (const DeclaredLoop& loop : declaration.loops) {
        const auto place_of = [&](std::uint32_t declared) {
            const auto found = std::lower_bound(plan.passes.begin(), plan.passes.end(), declared,
                                                [](const PlannedPass& p, std::uint32_t d) { return p.declared < d; });
            return static_cast<std::uint32_t>(found - plan.passes.begin());
        };
        const std::uint32_t first = place_of(loop.first), end = place_of(loop.first + loop.count);
        if (first < end) {
            plan.loops.push_back({first, end - first, {}});
        }
    }
}

std::vector<Turn> turns_of(const GraphDeclaration& declaration, const GraphPlan& plan) {
    std::vector<Turn> turns;
    const auto add = [&](const PlannedPass& pass, std::uint32_t round) {
        if (declaration.passes[pass.declared].rests) {
            return;
        }
        const Calls calls = calls_of(declaration, pass.declared);
        turns.push_back({&pass, calls.first + round * calls.step});
    };
    std::uint32_t index = 0;
    for (const PlannedLoop& loop : plan.loops) {
        for (; index < loop.first + loop.count; ++index) {
            add(plan.passes[index], 0);
        }
        const std::uint32_t rounds = calls_of(declaration, plan.passes[loop.first].declared).rounds;
        for (std::uint32_t round = 1; round < rounds; ++round) {
            for (const PlannedPass& pass : loop.again) {
                add(pass, round);
            }
        }
    }
    for (; index < plan.passes.size(); ++index) {
        add(plan.passes[index], 0);
    }
    return turns;
}

std::uint32_t most_turns(const GraphDeclaration& declaration, const GraphPlan& plan) {
    std::uint32_t most = 0;
    for (const PlannedPass& pass : plan.passes) {
        most += calls_of(declaration, pass.declared).rounds;
    }
    return most;
}

}  // namespace gn
