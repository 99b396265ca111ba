// SPDX-License-Identifier: MIT
// Weighted means, paired comparisons and a line through zero: what the two studies are evaluated with.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace gn {

/// A paired t-test: two values of each of several subjects.
struct PairedT {
    double difference = 0;     ///< weighted mean of a - b
    double t = 0;              ///< infinite where all differ alike
    double degrees = 0;        ///< of freedom
    double p = 1;              ///< two-sided
    double low = 0, high = 0;  ///< 95 % confidence interval of the difference
};

/// Weights say how much a subject's pair counts; their scale means nothing, and equal ones give the plain test. The degrees of
/// freedom are those of the effective number of subjects, (sum w)^2 / sum w^2, less one (Kish). Fewer than two: p = 1.
PairedT paired_t(std::span<const double> a, std::span<const double> b, std::span<const double> weights = {});

double weighted_mean(std::span<const double> values, std::span<const double> weights);

/// One technique's place in an order.
struct Placed {
    std::string name;
    double mean = 0;  ///< weighted mean rank
};

/// Names in the order of their means, every pair's test, and the subsets: the longest runs in that order within which no pair
/// differs at alpha / pairs (Bonferroni).
struct Ranking {
    std::vector<Placed> order;
    std::vector<std::vector<PairedT>> pairs;                   ///< [i][j], both in that order
    std::vector<std::pair<std::size_t, std::size_t>> subsets;  ///< first and last place
    double level = 0;                                          ///< alpha / pairs
    double subjects = 0;
};

/// `ranks`: a row a subject, a column a name. The lower the mean the better the place.
Ranking rank_techniques(const std::vector<std::string>& names, const std::vector<std::vector<double>>& ranks,
                        const std::vector<double>& weights, double alpha = 0.05);

/// r = c a by least squares, [Kre17] section 4.4.
struct LineFit {
    double c = 0, low = 0, high = 0;  ///< and its 95 % confidence interval
    std::size_t count = 0;
};
LineFit fit_through_zero(std::span<const double> a, std::span<const double> r);

}  // namespace gn
