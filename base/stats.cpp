// SPDX-License-Identifier: MIT
#include "base/stats.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gn {

double percentile(std::span<const double> values, double p) {
    GN_CHECK(!values.empty() && p >= 0.0 && p <= 1.0);
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const double place = p * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double median(std::span<const double> values) {
    return percentile(values, 0.5);
}

double Running::standard_error() const {
    return count_ == 0 ? 0.0 : std::sqrt(variance() / static_cast<double>(count_));
}

}  // namespace gn
