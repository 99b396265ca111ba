// SPDX-License-Identifier: MIT
// Poisson-disc sets made by relaxation dart throwing.
//
// Based on: McCool, Fiume. Hierarchical Poisson Disk Sampling Distributions. Graphics Interface 1992. [MF92]
#pragma once

#include "base/math.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

/// `count` points in the unit disc, no two nearer than `spacing`; deterministic in `seed`.
struct PoissonSet {
    std::vector<vec2> points;
    float spacing = 0;
};
PoissonSet poisson_disc(int count, unsigned seed);

/// Orders points so that any first few see the whole disc: each next one is the farthest from those before it.
void spread(std::span<vec2> points);

/// A GLSL macro `name(take)` that expands to take(x, y, counted) for every four points: their coordinates as vec4, and 1
/// for each point that is one, 0 where points ran out. Lists unroll where loops over tables do not.
std::string glsl_fours(std::string_view name, std::span<const vec2> points);

}  // namespace gn
