// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// How many objects a technique carries within a budget of milliseconds: section 4.2.1.
#pragma once

#include <optional>
#include <span>

namespace gn {

/// A frame of so many objects on a square target.
struct LimitSample {
    double objects = 0, target = 0;  ///< count; pixels along a side
    double frame_ms = 0;
};

struct Limits {
    /// Limit 1: the most objects at any target, and the largest target that still carries them.
    std::optional<double> most, most_at;
    /// Limit 2: the most objects at the largest target that was drawn.
    std::optional<double> at_largest;
    double largest = 0;
};

/// The most objects that keep within the budget at one target: between two tested counts interpolated linearly in time; absent
/// where the fewest tested take longer. It ends with the first count beyond the budget.
std::optional<double> most_objects(std::span<const LimitSample> samples, double target, double budget_ms);
Limits limits_of(std::span<const LimitSample> samples, double budget_ms);

}  // namespace gn
