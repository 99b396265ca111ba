// SPDX-License-Identifier: MIT
// Based on: Watson, Pelli. QUEST: A Bayesian Adaptive Psychometric Method. Perception & Psychophysics 33, 1983. [WP83]
// A threshold by trials, each where the last ones say that it tells most.
#pragma once

#include <cstddef>
#include <vector>

namespace gn {

/// Intensities x and thresholds are decimal logarithms. [Kre17] section 4.2 gives all but the deviation.
struct QuestParams {
    double guess = -0.47712125471966244;     ///< -log10 3: a filter of three artifacts hides them
    double deviation = 0.47712125471966244;  ///< of the guess: a factor of three
    double threshold = 0.82;                 ///< share of right answers at the threshold
    double beta = 3.5;                       ///< slope
    double delta = 0.01;                     ///< answers given in the dark
    double gamma = 0.5;                      ///< right answers of one who sees nothing
};

/// The offset that puts the threshold where the share of right answers is as asked for.
double quest_offset(const QuestParams& params);
/// How far above the threshold a trial tells most of it: where Fisher's information psi'^2 / (psi (1 - psi)) is greatest, at about
/// nine right answers in ten.
double best_offset(const QuestParams& params);
/// The share of right answers at an intensity, where the threshold is T.
double psychometric(const QuestParams& params, double x, double threshold);

class Quest {
  public:
    explicit Quest(const QuestParams& params = {});
    /// Where the next trial is: above the posterior's mean by what tells most.
    [[nodiscard]] double next() const { return mean() + best_offset_; }
    /// Of the threshold's posterior.
    [[nodiscard]] double mean() const;
    [[nodiscard]] double deviation() const;
    void update(double x, bool right);
    [[nodiscard]] int trials() const { return trials_; }
    /// At least ten trials, and sure to a tenth of a decade at twice the deviation.
    [[nodiscard]] bool converged() const;

  private:
    QuestParams params_;
    std::vector<double> log_posterior_;  ///< over thresholds, with any constant added
    double best_offset_ = 0, offset_ = 0;
    int trials_ = 0;
};

inline constexpr int quest_least_trials = 10;
inline constexpr double quest_sure_deviation = 0.045;

}  // namespace gn
