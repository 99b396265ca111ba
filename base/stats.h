// SPDX-License-Identifier: MIT
// Statistics of measured values.
#pragma once

#include <cstddef>
#include <span>

namespace gn {

/// The value below which a fraction p in [0,1] of the values lies, interpolated linearly between neighbours in order.
/// There must be at least one value.
double percentile(std::span<const double> values, double p);
double median(std::span<const double> values);

/// Mean and variance of a stream in one pass, without cancellation. Welford 1962.
class Running {
  public:
    void add(double x) {
        ++count_;
        const double before = x - mean_;
        mean_ += before / static_cast<double>(count_);
        squares_ += before * (x - mean_);
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] double mean() const { return mean_; }
    /// Unbiased; 0 for fewer than two values.
    [[nodiscard]] double variance() const { return count_ < 2 ? 0.0 : squares_ / static_cast<double>(count_ - 1); }
    /// Of the mean.
    [[nodiscard]] double standard_error() const;

  private:
    std::size_t count_ = 0;
    double mean_ = 0, squares_ = 0;
};

}  // namespace gn
