// SPDX-License-Identifier: MIT
#include "apps/evaluation/statistics.h"

#include "base/error.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace gn {
namespace {

/// What Student's t exceeds in magnitude with probability 5 %.
double critical_t(double degrees) {
    return boost::math::quantile(boost::math::complement(boost::math::students_t(degrees), 0.025));
}

std::vector<double> ones_where_empty(std::span<const double> weights, std::size_t count) {
    return weights.empty() ? std::vector<double>(count, 1.0) : std::vector<double>(weights.begin(), weights.end());
}

}  // namespace

double weighted_mean(std::span<const double> values, std::span<const double> weights) {
    const std::vector<double> w = ones_where_empty(weights, values.size());
    GN_CHECK_EQ(w.size(), values.size());
    const double sum = std::accumulate(w.begin(), w.end(), 0.0);
    return sum > 0 ? std::inner_product(values.begin(), values.end(), w.begin(), 0.0) / sum : 0.0;
}

PairedT paired_t(std::span<const double> a, std::span<const double> b, std::span<const double> weights) {
    GN_CHECK_EQ(a.size(), b.size());
    const std::vector<double> w = ones_where_empty(weights, a.size());
    GN_CHECK_EQ(w.size(), a.size());
    std::vector<double> differences(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        differences[i] = a[i] - b[i];
    }
    PairedT test;
    test.difference = test.low = test.high = weighted_mean(differences, w);
    const double sum = std::accumulate(w.begin(), w.end(), 0.0);
    const double squares = std::inner_product(w.begin(), w.end(), w.begin(), 0.0);
    const double subjects = squares > 0 ? sum * sum / squares : 0;
    if (subjects < 2 - 1e-9) {
        return test;
    }
    test.degrees = subjects - 1;
    // The unbiased variance under weights of reliability; with equal ones sum (d - mean)^2 / (n - 1).
    double variance = 0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        variance += w[i] * (differences[i] - test.difference) * (differences[i] - test.difference);
    }
    variance /= sum - squares / sum;
    const double error = std::sqrt(variance / subjects);
    if (error <= 1e-12 * std::abs(test.difference) || error == 0) {
        // All alike: no doubt, or no difference.
        test.t = test.difference == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), test.difference);
        test.p = test.difference == 0 ? 1 : 0;
        return test;
    }
    test.t = test.difference / error;
    test.p = 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(test.degrees), std::abs(test.t)));
    test.low = test.difference - critical_t(test.degrees) * error;
    test.high = test.difference + critical_t(test.degrees) * error;
    return test;
}

Ranking rank_techniques(const std::vector<std::string>& names, const std::vector<std::vector<double>>& ranks,
                        const std::vector<double>& weights, double alpha) {
    const std::size_t count = names.size();
    std::vector<std::vector<double>> columns(count);
    for (const std::vector<double>& row : ranks) {
        GN_CHECK_EQ(row.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
            columns[i].push_back(row[i]);
        }
    }
    // Order by mean.
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> means;
    for (const std::vector<double>& column : columns) {
        means.push_back(weighted_mean(column, weights));
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return means[a] < means[b]; });
    Ranking ranking;
    ranking.subjects = static_cast<double>(ranks.size());
    ranking.level = count > 1 ? alpha / (0.5 * static_cast<double>(count * (count - 1))) : alpha;
    for (const std::size_t i : order) {
        ranking.order.push_back({names[i], means[i]});
        std::vector<PairedT> row;
        for (const std::size_t j : order) {
            row.push_back(paired_t(columns[i], columns[j], weights));
        }
        ranking.pairs.push_back(std::move(row));
    }
    // From each place as far as no pair differs; runs inside others are left out.
    std::size_t reached = 0;
    for (std::size_t first = 0; first < count; ++first) {
        std::size_t last = first;
        const auto differs = [&](std::size_t next) {
            for (std::size_t i = first; i < next; ++i) {
                if (ranking.pairs[i][next].p <= ranking.level) {
                    return true;
                }
            }
            return false;
        };
        while (last + 1 < count && !differs(last + 1)) {
            ++last;
        }
        if (first == 0 || last > reached) {
            ranking.subsets.emplace_back(first, last);
            reached = last;
        }
    }
    return ranking;
}

LineFit fit_through_zero(std::span<const double> a, std::span<const double> r) {
    GN_CHECK_EQ(a.size(), r.size());
    LineFit fit;
    fit.count = a.size();
    const double squares = std::inner_product(a.begin(), a.end(), a.begin(), 0.0);
    if (!(squares > 0)) {
        return fit;
    }
    fit.c = fit.low = fit.high = std::inner_product(a.begin(), a.end(), r.begin(), 0.0) / squares;
    if (fit.count > 1) {
        double residuals = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            residuals += (r[i] - fit.c * a[i]) * (r[i] - fit.c * a[i]);
        }
        const auto degrees = static_cast<double>(fit.count - 1);
        const double error = critical_t(degrees) * std::sqrt(residuals / degrees / squares);
        fit.low = fit.c - error;
        fit.high = fit.c + error;
    }
    return fit;
}

}  // namespace gn
