// SPDX-License-Identifier: MIT
// Errors by name. T: the technique's visibility, R: the reference's, over the counted samples.
#pragma once

#include "base/image.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

/// The same figures where each sample counts by the light that it would get unshadowed: what reaches the eye. A lamp just
/// above a floor, or a grazing sun, gives most samples next to nothing.
struct WeightedErrors {
    std::optional<double> rmse, mae, mismatch, leak, acne, penumbra;
    double all = 0, dark = 0, lit = 0, partial = 0;  ///< sums of the weights behind them
};
struct WeightedInfo {
    std::string_view name;
    std::optional<double> WeightedErrors::*value;
};
std::span<const WeightedInfo> weighted_metrics();

/// Every figure; a value that has no samples is absent, never 0.
struct Errors {
    std::size_t samples = 0;
    std::optional<double> rmse, mae, max, mismatch, leak, acne, self_shadow, penumbra, edge, undersampled,
        undersampling, luma_rms, flip, flicker, path_rmse, against, against_mean;
    std::size_t dark = 0, lit = 0,
                partial = 0;  ///< samples with R = 0, R = 1, 0 < R < 1: the weights of leak, acne, penumbra
    WeightedErrors weighted;
};

struct MetricInfo {
    std::string_view name, sentence;
    std::optional<double> Errors::*value;
};
/// In the order of the report: rmse, mae, max, mismatch, leak, acne, self_shadow, penumbra, edge, undersampled,
/// undersampling, luma_rms, flip, flicker, path_rmse, against, against_mean.
std::span<const MetricInfo> all_metrics();

/// The visibility metrics (rmse .. edge) of width x height images; `counted` has one byte a pixel. A T that is not a
/// number counts as wholly wrong.
Errors visibility_errors(std::span<const float> technique, std::span<const float> reference,
                         std::span<const std::uint8_t> counted, int width, int height);
/// Fills `weighted`: weights[i] >= 0, the unshadowed illuminance of sample i, lux, its cosine included.
void weigh_errors(Errors& errors, std::span<const float> technique, std::span<const float> reference,
                  std::span<const std::uint8_t> counted, std::span<const float> weights);
/// Fills `self_shadow`: the part of `acne` that no shadow nearby explains, over the same lit samples. `beside_shadow` has
/// 1 where a shadow's edge lies within the technique's reach.
void split_acne(Errors& errors, std::span<const float> technique, std::span<const float> reference,
                std::span<const std::uint8_t> counted, std::span<const std::uint8_t> beside_shadow);
/// The pixels within one pixel of a discontinuity of R: what `edge` counts; exact methods are judged outside it.
/// 1 for a counted pixel when R spans at least one half over the counted pixels of its 3 x 3 neighbourhood.
std::vector<std::uint8_t> edge_pixels(std::span<const float> reference, std::span<const std::uint8_t> counted,
                                      int width, int height);
/// Fills `against` and `against_mean`: the technique's visibility held against that of another technique, over the
/// same counted samples. What is not a number in either of them counts as a difference of 1.
void hold_against(Errors& errors, std::span<const float> technique, std::span<const float> other,
                  std::span<const std::uint8_t> counted);
/// Fills `undersampled` and `undersampling`. m: of every counted sample that a light view holds, the pixels under a map texel
/// (shadow/show/show.h); empty where there is no map: both stay absent.
void judge_texels(Errors& errors, std::span<const float> m);
/// One channel of values that are interleaved, a value a sample.
std::vector<float> channel_of(std::span<const float> interleaved, int channels, int channel);
/// The errors of a light's channels as those of the light: each channel's samples count alike, and each sample once.
Errors pool_channels(std::span<const Errors> channels);
/// Several lights pooled: as if their samples were one list. Figures of pictures and paths are not samples of a light and
/// stay absent; so are those of texels, whose percentile is one of samples and not of figures.
Errors pool(std::span<const Errors> lights);

/// Display-ready RGB pictures in [0,1], sRGB-encoded, of one size. A fourth channel is ignored.
double luma_rms(const Image& a, const Image& b);
/// Mean FLIP, and its map when `map` is given. Andersson et al. 2020. pixels_per_degree as the paper's default.
double flip(const Image& a, const Image& b, Image* map = nullptr, float pixels_per_degree = 67.0206F);

}  // namespace gn
