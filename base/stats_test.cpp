// SPDX-License-Identifier: MIT
#include "base/stats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gn::stats_test {
namespace {

TEST(Stats, MedianAndPercentiles) {
    EXPECT_EQ(median(std::vector<double>{3}), 3);
    EXPECT_EQ(median(std::vector<double>{9, 1, 5}), 5);
    EXPECT_EQ(median(std::vector<double>{4, 1, 3, 2}), 2.5);
    const std::vector<double> values{50, 10, 40, 20, 30};
    EXPECT_EQ(percentile(values, 0), 10);
    EXPECT_EQ(percentile(values, 1), 50);
    EXPECT_EQ(percentile(values, 0.25), 20);
    EXPECT_EQ(percentile(values, 0.1), 14);
}

TEST(Stats, RunningMeanAndVariance) {
    Running running;
    EXPECT_EQ(running.standard_error(), 0);
    running.add(5);
    EXPECT_EQ(running.variance(), 0);
    // A large offset does not cancel.
    Running shifted;
    for (const double x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) {
        shifted.add(1e9 + x);
    }
    EXPECT_DOUBLE_EQ(shifted.mean(), 1e9 + 5);
    EXPECT_NEAR(shifted.variance(), 32.0 / 7, 1e-6);
    EXPECT_NEAR(shifted.standard_error(), std::sqrt(32.0 / 7 / 8), 1e-7);
    EXPECT_EQ(shifted.count(), 8U);
}

}  // namespace
}  // namespace gn::stats_test
