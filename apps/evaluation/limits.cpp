// SPDX-License-Identifier: MIT
#include "apps/evaluation/limits.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace gn {

std::optional<double> most_objects(std::span<const LimitSample> samples, double target, double budget_ms) {
    std::map<double, double> ms;
    for (const LimitSample& sample : samples) {
        if (sample.target == target) {
            ms[sample.objects] = sample.frame_ms;
        }
    }
    std::optional<double> most;
    double before_objects = 0, before_ms = 0;
    for (const auto& [objects, took] : ms) {
        if (took > budget_ms) {
            // Whole objects only, between a count that is within and one that is not.
            return most ? std::optional<double>(
                              std::floor(before_objects +
                                         (objects - before_objects) * (budget_ms - before_ms) / (took - before_ms)))
                        : std::nullopt;
        }
        most = before_objects = objects;
        before_ms = took;
    }
    return most;
}

Limits limits_of(std::span<const LimitSample> samples, double budget_ms) {
    std::set<double> targets;
    for (const LimitSample& sample : samples) {
        targets.insert(sample.target);
    }
    Limits limits;
    // From the largest target down, so that the first of equals is the largest.
    for (auto target = targets.rbegin(); target != targets.rend(); ++target) {
        const std::optional<double> most = most_objects(samples, *target, budget_ms);
        if (target == targets.rbegin()) {
            limits.at_largest = most;
            limits.largest = *target;
        }
        if (most && (!limits.most || *most > *limits.most)) {
            limits.most = most;
            limits.most_at = *target;
        }
    }
    return limits;
}

}  // namespace gn
