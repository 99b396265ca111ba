// SPDX-License-Identifier: MIT
#include "apps/evaluation/quest.h"

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

// Thresholds from the guess - 2.5 to the guess + 2.5 decades.
constexpr double half_range = 2.5, grain = 0.01;
constexpr std::size_t cells = 501;
constexpr double ln10 = 2.302585092994046;

double threshold_at(const QuestParams& params, std::size_t cell) {
    return params.guess - half_range + grain * static_cast<double>(cell);
}

/// Mean of the distance from `from`, or of its square, over the posterior.
double moment(const QuestParams& params, const std::vector<double>& log_posterior, double from, bool square) {
    const double most = *std::max_element(log_posterior.begin(), log_posterior.end());
    double sum = 0, weighted = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        const double weight = std::exp(log_posterior[i] - most);
        sum += weight;
        const double distance = threshold_at(params, i) - from;
        weighted += weight * (square ? distance * distance : distance);
    }
    return weighted / sum;
}

}  // namespace

double quest_offset(const QuestParams& p) {
    // psi(T) = threshold, solved for the offset: 0.00484 for the default figures.
    const double seen = (p.threshold - p.delta * p.gamma) / (1 - p.delta);
    return std::log10(-std::log((1 - seen) / (1 - p.gamma))) / p.beta;
}

double best_offset(const QuestParams& params) {
    double best = 0, most = 0;
    for (double x = -0.5; x < 0.5; x += 0.001) {
        constexpr double step = 1e-4;
        const double share = psychometric(params, x, 0);
        const double slope = (psychometric(params, x + step, 0) - psychometric(params, x - step, 0)) / (2 * step);
        const double information = slope * slope / (share * (1 - share));
        if (information > most) {
            most = information;
            best = x;
        }
    }
    return best;
}

double psychometric(const QuestParams& p, double x, double threshold) {
    // [WP83] eq. 3 with lapses: a Weibull function of 10^x.
    const double weibull = 1 - (1 - p.gamma) * std::exp(-std::exp(ln10 * p.beta * (x - threshold + quest_offset(p))));
    return p.delta * p.gamma + (1 - p.delta) * weibull;
}

Quest::Quest(const QuestParams& params)
    : params_(params), log_posterior_(cells), best_offset_(best_offset(params)), offset_(quest_offset(params)) {
    for (std::size_t i = 0; i < cells; ++i) {
        const double z = (threshold_at(params, i) - params.guess) / params.deviation;
        log_posterior_[i] = -0.5 * z * z;
    }
}

double Quest::mean() const {
    return moment(params_, log_posterior_, 0, false);
}

double Quest::deviation() const {
    return std::sqrt(moment(params_, log_posterior_, mean(), true));
}

void Quest::update(double x, bool right) {
    // psychometric() of every threshold: each cell's Weibull power is the next one's times a constant.
    const double step = std::exp(-ln10 * params_.beta * grain);
    double power = std::exp(ln10 * params_.beta * (x - threshold_at(params_, 0) + offset_));
    for (std::size_t i = 0; i < cells; ++i, power *= step) {
        const double weibull = 1 - (1 - params_.gamma) * std::exp(-power);
        const double share = params_.delta * params_.gamma + (1 - params_.delta) * weibull;
        log_posterior_[i] += std::log(right ? share : 1 - share);
    }
    ++trials_;
}

bool Quest::converged() const {
    return trials_ >= quest_least_trials && deviation() <= quest_sure_deviation;
}

}  // namespace gn
