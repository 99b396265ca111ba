// SPDX-License-Identifier: MIT
// Poisson-disc sets made by relaxation dart throwing.
//
// Based on: McCool, Fiume. Hierarchical Poisson Disk Sampling Distributions. Graphics Interface 1992. [MF92]
#pragma once

#include "base/math.h"

#include <string>
#include <vector>

namespace gn {

/// `count` points in the unit disc, no two nearer than `spacing`; deterministic in `seed`.
struct PoissonSet {
    std::vector<vec2> points;
    float spacing = 0;
};
PoissonSet poisson_disc(int count, unsigned seed);

/// The set as a GLSL constant array `name`.
std::string glsl_array(const PoissonSet& set, const std::string& name);

}  // namespace gn
