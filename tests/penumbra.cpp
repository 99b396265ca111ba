// SPDX-License-Identifier: MIT
#include "tests/penumbra.h"

#include <cmath>

namespace gn::test {

double Slice::standard_error() const {
    return std::sqrt(std::max(squares / samples - mean() * mean(), 0.0) / samples);
}

std::vector<Slice> error_slices(const Comparison& c, std::size_t count) {
    std::vector<Slice> slices(count);
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const float x = c.frame.samples.position_ws[i].x;
        if (c.truth.counted[i] == 0 || std::abs(x) >= 1) {
            continue;
        }
        const double wrong = c.visibility().values[i] - c.truth.visibility[i];
        Slice& slice = slices.at(static_cast<std::size_t>(0.5F * static_cast<float>(count) * (x + 1)));
        slice.sum += wrong;
        slice.squares += wrong * wrong;
        ++slice.samples;
    }
    return slices;
}

vec2 error_halves(const Comparison& c) {
    dvec2 sum(0), count(0);
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const float v = c.truth.visibility[i];
        if (c.truth.counted[i] != 0 && v > 0.02F && v < 0.98F) {
            const int half = v > 0.5F ? 1 : 0;
            sum[half] += static_cast<double>(c.visibility().values[i] - v);
            count[half] += 1;
        }
    }
    return {sum / count};
}

}  // namespace gn::test
