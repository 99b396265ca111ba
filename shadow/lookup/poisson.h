// SPDX-License-Identifier: MIT
// Poisson-disc sets made by relaxation dart throwing.
//
// Based on: McCool, Fiume. Hierarchical Poisson Disk Sampling Distributions. Graphics Interface 1992. [MF92]
#pragma once

#include "base/math.h"

#include <span>
#include <string>
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

/// Points as a GLSL constant array `name`.
std::string glsl_array(std::span<const vec2> points, const std::string& name);

}  // namespace gn
