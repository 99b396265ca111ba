// SPDX-License-Identifier: MIT
// How wrong V is across a penumbra, by where or by how much of the light the truth sees.
#pragma once

#include "tests/rig.h"

namespace gn::test {

/// V minus the truth, of some samples.
struct Slice {
    double sum = 0, squares = 0;
    int samples = 0;
    [[nodiscard]] double mean() const { return sum / samples; }
    /// Of the mean, by its own variance.
    [[nodiscard]] double standard_error() const;
};

/// Slices of equal width across x from -1 to 1 m, where half-plane's penumbra lies.
std::vector<Slice> error_slices(const Comparison& c, std::size_t count);

/// Means over the penumbra's dark and lit half.
vec2 error_halves(const Comparison& c);

}  // namespace gn::test
