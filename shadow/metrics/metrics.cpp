// SPDX-License-Identifier: MIT
#include "shadow/metrics/metrics.h"

#include "base/error.h"
#include "base/stats.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gn {
namespace {

/// Sums over one set of samples.
struct Sum {
    std::size_t count = 0;
    double absolute = 0, squares = 0;
    void add(double difference) {
        ++count;
        absolute += std::abs(difference);
        squares += difference * difference;
    }
    [[nodiscard]] std::optional<double> over_count(double sum) const {
        return count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
    }
    [[nodiscard]] std::optional<double> mean() const { return over_count(absolute); }
    [[nodiscard]] std::optional<double> root_mean_square() const {
        return count == 0 ? std::nullopt : std::optional(std::sqrt(squares / static_cast<double>(count)));
    }
};

/// The same where every sample has a weight.
struct WeightedSum {
    double weight = 0, absolute = 0, squares = 0;
    void add(double difference, double w) {
        weight += w;
        absolute += w * std::abs(difference);
        squares += w * difference * difference;
    }
    [[nodiscard]] std::optional<double> over_weight(double sum) const {
        return weight > 0.0 ? std::optional(sum / weight) : std::nullopt;
    }
    [[nodiscard]] std::optional<double> mean() const { return over_weight(absolute); }
    [[nodiscard]] std::optional<double> root_mean_square() const {
        return weight > 0.0 ? std::optional(std::sqrt(squares / weight)) : std::nullopt;
    }
};

/// T - R, where a T that is not a number is wholly wrong.
double difference_of(float technique, double r) {
    const double wrong = r < 0.5 ? 1.0 : 0.0;
    return (std::isfinite(technique) ? static_cast<double>(technique) : wrong) - r;
}

/// The mean of one figure over lights, each weighted by the samples that it was taken from.
std::optional<double> weighted_mean(std::span<const Errors> lights, std::optional<double> Errors::*value,
                                    std::size_t Errors::*weight, bool squared) {
    double sum = 0;
    double weights = 0;
    for (const Errors& light : lights) {
        if ((light.*value).has_value()) {
            const double v = *(light.*value);
            const auto w = static_cast<double>(light.*weight);
            sum += w * (squared ? v * v : v);
            weights += w;
        }
    }
    if (weights <= 0) {
        return std::nullopt;
    }
    return squared ? std::sqrt(sum / weights) : sum / weights;
}

/// Lights pooled by the light that they give.
WeightedErrors pool_weighted(std::span<const Errors> lights) {
    using Figure = std::optional<double> WeightedErrors::*;
    using Weight = double WeightedErrors::*;
    WeightedErrors pooled;
    const auto mean = [&](Figure figure, Weight weight, bool squared) {
        WeightedSum sum;
        for (const Errors& light : lights) {
            if (const std::optional<double>& value = light.weighted.*figure) {
                sum.add(*value, light.weighted.*weight);
            }
        }
        pooled.*figure = squared ? sum.root_mean_square() : sum.mean();
    };
    mean(&WeightedErrors::rmse, &WeightedErrors::all, true);
    mean(&WeightedErrors::mae, &WeightedErrors::all, false);
    mean(&WeightedErrors::mismatch, &WeightedErrors::all, false);
    mean(&WeightedErrors::leak, &WeightedErrors::dark, false);
    mean(&WeightedErrors::acne, &WeightedErrors::lit, false);
    mean(&WeightedErrors::penumbra, &WeightedErrors::partial, true);
    for (const Errors& light : lights) {
        pooled.all += light.weighted.all;
        pooled.dark += light.weighted.dark;
        pooled.lit += light.weighted.lit;
        pooled.partial += light.weighted.partial;
    }
    return pooled;
}

}  // namespace

std::span<const MetricInfo> all_metrics() {
    static constexpr std::array<MetricInfo, 17> metrics{{
        {"rmse", "Root mean square of T - R.", &Errors::rmse},
        {"mae", "Mean of the absolute T - R.", &Errors::mae},
        {"max", "Largest absolute T - R.", &Errors::max},
        {"mismatch", "Fraction of samples where T and R differ by more than a half.", &Errors::mismatch},
        {"leak", "Mean of T where R is 0: light where there is none.", &Errors::leak},
        {"acne", "Mean of 1 - T where R is 1: shadow where there is none.", &Errors::acne},
        {"self_shadow", "The part of acne that no edge of another surface within the kernel's reach explains.",
         &Errors::self_shadow},
        {"penumbra", "Root mean square of T - R where R is between 0 and 1.", &Errors::penumbra},
        {"edge", "Fraction of samples within one pixel of a discontinuity of R.", &Errors::edge},
        {"undersampled", "Fraction of samples where a map texel covers more than a pixel in some direction (m > 1).",
         &Errors::undersampled},
        {"undersampling", "Pixels under a map texel where it covers most, m: 95 % of the samples have less.",
         &Errors::undersampling},
        {"luma_rms", "Root mean square difference of the pictures' luma, on the scale of 0 to 255.", &Errors::luma_rms},
        {"flip", "Mean FLIP of the pictures: the difference an observer sees when they alternate.", &Errors::flip},
        {"flicker", "Root mean square change of T - R between frames at reprojected samples.", &Errors::flicker},
        {"path_rmse", "Root mean square of T - R over all frames of the camera path.", &Errors::path_rmse},
        {"against", "Root mean square of T - A, A: the visibility of the recipe that --against names.",
         &Errors::against},
        {"against_mean", "Mean of T - A; above 0 the recipe lets more light through than that of --against.",
         &Errors::against_mean},
    }};
    return metrics;
}

Errors visibility_errors(std::span<const float> technique, std::span<const float> reference,
                         std::span<const std::uint8_t> counted, int width, int height) {
    const std::vector<std::uint8_t> edges = edge_pixels(reference, counted, width, height);
    GN_CHECK_EQ(technique.size(), reference.size());
    Sum all;
    Sum dark;
    Sum lit;
    Sum partial;
    std::size_t mismatched = 0;
    std::size_t edge = 0;
    double largest = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        if (counted[i] == 0) {
            continue;
        }
        const auto r = static_cast<double>(reference[i]);
        const double difference = difference_of(technique[i], r);
        all.add(difference);
        (r <= 0.0 ? dark : r >= 1.0 ? lit : partial).add(difference);
        mismatched += std::abs(difference) > 0.5 ? 1U : 0U;
        edge += edges[i];
        largest = std::max(largest, std::abs(difference));
    }

    Errors errors;
    errors.samples = all.count;
    errors.dark = dark.count;
    errors.lit = lit.count;
    errors.partial = partial.count;
    errors.rmse = all.root_mean_square();
    errors.mae = all.mean();
    errors.max = all.count == 0 ? std::nullopt : std::optional(largest);
    errors.mismatch = all.over_count(static_cast<double>(mismatched));
    errors.leak = dark.mean();
    errors.acne = lit.mean();
    errors.penumbra = partial.root_mean_square();
    errors.edge = all.over_count(static_cast<double>(edge));
    return errors;
}

std::span<const WeightedInfo> weighted_metrics() {
    static constexpr std::array<WeightedInfo, 6> metrics{{{"rmse", &WeightedErrors::rmse},
                                                          {"mae", &WeightedErrors::mae},
                                                          {"mismatch", &WeightedErrors::mismatch},
                                                          {"leak", &WeightedErrors::leak},
                                                          {"acne", &WeightedErrors::acne},
                                                          {"penumbra", &WeightedErrors::penumbra}}};
    return metrics;
}

void weigh_errors(Errors& errors, std::span<const float> technique, std::span<const float> reference,
                  std::span<const std::uint8_t> counted, std::span<const float> weights) {
    GN_CHECK_EQ(technique.size(), reference.size());
    GN_CHECK_EQ(weights.size(), reference.size());
    WeightedSum all;
    WeightedSum dark;
    WeightedSum lit;
    WeightedSum partial;
    double mismatched = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        const auto weight = static_cast<double>(weights[i]);
        if (counted[i] == 0 || !(weight > 0.0) || !std::isfinite(weight)) {
            continue;
        }
        const auto r = static_cast<double>(reference[i]);
        const double difference = difference_of(technique[i], r);
        all.add(difference, weight);
        (r <= 0.0 ? dark : r >= 1.0 ? lit : partial).add(difference, weight);
        mismatched += std::abs(difference) > 0.5 ? weight : 0.0;
    }
    WeightedErrors& weighted = errors.weighted;
    weighted = {.all = all.weight, .dark = dark.weight, .lit = lit.weight, .partial = partial.weight};
    weighted.rmse = all.root_mean_square();
    weighted.mae = all.mean();
    weighted.mismatch = all.over_weight(mismatched);
    weighted.leak = dark.mean();
    weighted.acne = lit.mean();
    weighted.penumbra = partial.root_mean_square();
}

void split_acne(Errors& errors, std::span<const float> technique, std::span<const float> reference,
                std::span<const std::uint8_t> counted, std::span<const std::uint8_t> beside_shadow) {
    GN_CHECK_EQ(technique.size(), reference.size());
    GN_CHECK_EQ(beside_shadow.size(), reference.size());
    Sum lit;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        if (counted[i] != 0 && reference[i] >= 1.0F) {
            const double dark = std::isfinite(technique[i]) ? 1.0 - static_cast<double>(technique[i]) : 1.0;
            lit.add(beside_shadow[i] != 0 ? 0.0 : dark);
        }
    }
    errors.self_shadow = lit.mean();
}

void hold_against(Errors& errors, std::span<const float> technique, std::span<const float> other,
                  std::span<const std::uint8_t> counted) {
    GN_CHECK_EQ(technique.size(), counted.size());
    GN_CHECK_EQ(other.size(), counted.size());
    Sum all;
    double signed_sum = 0;
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (counted[i] != 0) {
            const double difference = static_cast<double>(technique[i]) - static_cast<double>(other[i]);
            all.add(std::isfinite(difference) ? difference : 1.0);
            signed_sum += std::isfinite(difference) ? difference : 1.0;
        }
    }
    errors.against = all.root_mean_square();
    errors.against_mean = all.over_count(signed_sum);
}

void judge_texels(Errors& errors, std::span<const float> m) {
    if (m.empty()) {
        return;
    }
    const auto coarse = static_cast<double>(std::count_if(m.begin(), m.end(), [](float one) { return one > 1.0F; }));
    errors.undersampled = coarse / static_cast<double>(m.size());
    errors.undersampling = percentile(std::vector<double>(m.begin(), m.end()), 0.95);
}

std::vector<float> channel_of(std::span<const float> interleaved, int channels, int channel) {
    GN_CHECK(channels > 0 && channel >= 0 && channel < channels);
    const auto step = static_cast<std::size_t>(channels);
    std::vector<float> values(interleaved.size() / step);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = interleaved[step * i + static_cast<std::size_t>(channel)];
    }
    return values;
}

Errors pool_channels(std::span<const Errors> channels) {
    GN_CHECK(!channels.empty());
    Errors pooled = pool(channels);
    pooled.samples /= channels.size();
    pooled.dark /= channels.size();
    pooled.lit /= channels.size();
    pooled.partial /= channels.size();
    for (double WeightedErrors::*weight :
         {&WeightedErrors::all, &WeightedErrors::dark, &WeightedErrors::lit, &WeightedErrors::partial}) {
        pooled.weighted.*weight /= static_cast<double>(channels.size());
    }
    return pooled;
}

Errors pool(std::span<const Errors> lights) {
    Errors pooled;
    for (const Errors& light : lights) {
        pooled.samples += light.samples;
        pooled.dark += light.dark;
        pooled.lit += light.lit;
        pooled.partial += light.partial;
        if (light.max.has_value()) {
            pooled.max = std::max(pooled.max.value_or(0.0), *light.max);
        }
    }
    pooled.rmse = weighted_mean(lights, &Errors::rmse, &Errors::samples, true);
    pooled.mae = weighted_mean(lights, &Errors::mae, &Errors::samples, false);
    pooled.mismatch = weighted_mean(lights, &Errors::mismatch, &Errors::samples, false);
    pooled.leak = weighted_mean(lights, &Errors::leak, &Errors::dark, false);
    pooled.acne = weighted_mean(lights, &Errors::acne, &Errors::lit, false);
    pooled.self_shadow = weighted_mean(lights, &Errors::self_shadow, &Errors::lit, false);
    pooled.penumbra = weighted_mean(lights, &Errors::penumbra, &Errors::partial, true);
    pooled.edge = weighted_mean(lights, &Errors::edge, &Errors::samples, false);
    pooled.against = weighted_mean(lights, &Errors::against, &Errors::samples, true);
    pooled.against_mean = weighted_mean(lights, &Errors::against_mean, &Errors::samples, false);
    pooled.weighted = pool_weighted(lights);
    return pooled;
}

}  // namespace gn
