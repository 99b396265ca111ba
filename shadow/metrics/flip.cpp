// SPDX-License-Identifier: MIT
// Based on: Pontus Andersson, Jim Nilsson, Tomas Akenine-Moller, Magnus Oskarsson, Kalle Astrom, Mark D. Fairchild.
// FLIP: A Difference Evaluator for Alternating Images. PACM CGIT (HPG) 2020. [ANA+20]
//
//   pictures -> YCxCz -> blurred as the eye does at this distance -> L*a*b* -> colour difference  \__ FLIP
//           \-> lightness -> edges and points                    -> feature difference            /
//
// All filters are sums of products of one-dimensional ones, so each runs as rows, then columns.
#include "base/error.h"
#include "shadow/metrics/flip_color.h"
#include "shadow/metrics/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace gn {
namespace {

using Plane = std::vector<float>;
using Taps = std::vector<float>;  ///< odd count, centred

// [ANA+20, sections 4.1.3 and 4.2]
constexpr float colour_exponent = 0.7F;
constexpr float colour_knee = 0.4F;         ///< p_c: of the largest difference
constexpr float colour_knee_value = 0.95F;  ///< p_t: what the knee is mapped to
constexpr float feature_width = 0.082F;     ///< w, degrees
constexpr float feature_exponent = 0.5F;

int taps_radius(const Taps& taps) {
    return static_cast<int>(taps.size() / 2);
}

/// Filters along rows (step 1) or columns (step width); beyond the border the last pixel repeats.
void filter_rows(const Plane& in, Plane& out, int width, int height, const Taps& taps) {
    const int radius = taps_radius(taps);
    std::vector<float> padded(static_cast<std::size_t>(width + 2 * radius));
    for (int y = 0; y < height; ++y) {
        const float* row = in.data() + static_cast<std::ptrdiff_t>(y) * width;
        std::fill_n(padded.begin(), radius, row[0]);
        std::copy_n(row, width, padded.begin() + radius);
        std::fill_n(padded.begin() + radius + width, radius, row[width - 1]);
        float* result = out.data() + static_cast<std::ptrdiff_t>(y) * width;
        std::fill_n(result, width, 0.0F);
        for (std::size_t k = 0; k < taps.size(); ++k) {
            const float* source = padded.data() + k;
            for (int x = 0; x < width; ++x) {
                result[x] += taps[k] * source[x];
            }
        }
    }
}

void filter_columns(const Plane& in, Plane& out, int width, int height, const Taps& taps) {
    const int radius = taps_radius(taps);
    std::fill(out.begin(), out.end(), 0.0F);
    for (int y = 0; y < height; ++y) {
        float* result = out.data() + static_cast<std::ptrdiff_t>(y) * width;
        for (int k = -radius; k <= radius; ++k) {
            const float weight = taps[static_cast<std::size_t>(k + radius)];
            const float* source = in.data() + static_cast<std::ptrdiff_t>(std::clamp(y + k, 0, height - 1)) * width;
            for (int x = 0; x < width; ++x) {
                result[x] += weight * source[x];
            }
        }
    }
}

Plane separable(const Plane& in, int width, int height, const Taps& rows, const Taps& columns) {
    Plane between(in.size());
    Plane out(in.size());
    filter_rows(in, between, width, height, rows);
    filter_columns(between, out, width, height, columns);
    return out;
}

/// One Gaussian of a contrast sensitivity function: a sqrt(pi/b) exp(-pi^2 x^2 / b), x in degrees. [ANA+20, eq. 1]
struct Sensitivity {
    float a, b;
};
constexpr Sensitivity achromatic{1.0F, 0.0047F};
constexpr Sensitivity red_green{1.0F, 0.0053F};
constexpr std::array<Sensitivity, 2> blue_yellow{{{34.1F, 0.04F}, {13.5F, 0.025F}}};
constexpr float widest_b = 0.04F;

/// All kernels reach as far as three standard deviations of the widest.
int sensitivity_radius(float pixels_per_degree) {
    return static_cast<int>(std::ceil(3.0F * std::sqrt(widest_b / (2.0F * pi * pi)) * pixels_per_degree));
}

/// The one-dimensional factor exp(-pi^2 x^2 / b), not normalized.
Taps sensitivity_taps(float b, float pixels_per_degree) {
    const int radius = sensitivity_radius(pixels_per_degree);
    Taps taps;
    for (int i = -radius; i <= radius; ++i) {
        const float degrees = static_cast<float>(i) / pixels_per_degree;
        taps.push_back(std::exp(-pi * pi * degrees * degrees / b));
    }
    return taps;
}

float sum_of(const Taps& taps) {
    return std::accumulate(taps.begin(), taps.end(), 0.0F);
}

Taps scaled(Taps taps, float factor) {
    for (float& tap : taps) {
        tap *= factor;
    }
    return taps;
}

/// Blurs one opponent channel; the weights of the whole two-dimensional kernel sum to one.
Plane blur(const Plane& in, int width, int height, std::span<const Sensitivity> gaussians, float pixels_per_degree) {
    // Total weight of the two-dimensional kernel: the square of each factor's sum.
    float total = 0;
    for (const Sensitivity& g : gaussians) {
        const float sum = sum_of(sensitivity_taps(g.b, pixels_per_degree));
        total += g.a * std::sqrt(pi / g.b) * sum * sum;
    }
    Plane out(in.size(), 0.0F);
    for (const Sensitivity& g : gaussians) {
        const Taps taps = sensitivity_taps(g.b, pixels_per_degree);
        const Plane part = separable(in, width, height, scaled(taps, g.a * std::sqrt(pi / g.b) / total), taps);
        std::transform(out.begin(), out.end(), part.begin(), out.begin(), std::plus<>());
    }
    return out;
}

/// A picture as planes.
struct Planes {
    int width, height;
    std::array<Plane, 3> ycxcz;
};

Planes opponent_planes(const Image& image) {
    Planes planes{image.width, image.height, {}};
    for (Plane& plane : planes.ycxcz) {
        plane.resize(image.pixels());
    }
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const float* c = image.values.data() + i * static_cast<std::size_t>(image.channels);
        const auto decode = [](float v) { return linear_from_srgb(v > 0.0F ? std::min(v, 1.0F) : 0.0F); };
        const vec3 xyz = flip_color::xyz_from_linear({decode(c[0]), decode(c[1]), decode(c[2])});
        const vec3 opponent = flip_color::ycxcz_from_xyz(xyz);
        for (int k = 0; k < 3; ++k) {
            planes.ycxcz[static_cast<std::size_t>(k)][i] = opponent[k];
        }
    }
    return planes;
}

/// What the eye resolves, as Hunt-adjusted L*a*b*. [ANA+20, section 4.1.1]
std::vector<vec3> perceived(const Planes& planes, float pixels_per_degree) {
    const int w = planes.width;
    const int h = planes.height;
    const Plane y = blur(planes.ycxcz[0], w, h, std::span(&achromatic, 1), pixels_per_degree);
    const Plane cx = blur(planes.ycxcz[1], w, h, std::span(&red_green, 1), pixels_per_degree);
    const Plane cz = blur(planes.ycxcz[2], w, h, blue_yellow, pixels_per_degree);
    std::vector<vec3> lab(y.size());
    for (std::size_t i = 0; i < lab.size(); ++i) {
        // Blurred opponents may leave the display's gamut.
        const vec3 rgb = flip_color::linear_from_xyz(flip_color::xyz_from_ycxcz({y[i], cx[i], cz[i]}));
        lab[i] = flip_color::hunt_adjusted(
            flip_color::lab_from_xyz(flip_color::xyz_from_linear(glm::clamp(rgb, 0.0F, 1.0F))));
    }
    return lab;
}

/// Maps differences to [0,1]: most of the range for the smaller ones, the rest compressed. [ANA+20, section 4.1.3]
float redistributed(float difference) {
    static const float largest = flip_color::largest_difference();
    const float knee = colour_knee * largest;
    const float d = std::pow(difference, colour_exponent);
    const float mapped = d < knee ? colour_knee_value / knee * d
                                  : colour_knee_value + (d - knee) / (largest - knee) * (1.0F - colour_knee_value);
    return std::min(mapped, 1.0F);
}

/// Derivatives of a Gaussian; positive and negative weights each sum to one in magnitude. [ANA+20, section 4.2.1]
struct FeatureTaps {
    Taps gauss, first, second;
};

void normalize_sides(Taps& taps) {
    float positive = 0;
    float negative = 0;
    for (const float tap : taps) {
        (tap > 0 ? positive : negative) += tap;
    }
    for (float& tap : taps) {
        tap /= tap > 0 ? positive : -negative;
    }
}

FeatureTaps feature_taps(float pixels_per_degree) {
    const float sigma = 0.5F * feature_width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0F * sigma));
    FeatureTaps taps;
    for (int i = -radius; i <= radius; ++i) {
        const float x = static_cast<float>(i) / sigma;
        const float g = std::exp(-0.5F * x * x);
        taps.gauss.push_back(g);
        taps.first.push_back(-x * g);
        taps.second.push_back((x * x - 1.0F) * g);
    }
    taps.gauss = scaled(taps.gauss, 1.0F / sum_of(taps.gauss));
    normalize_sides(taps.first);
    normalize_sides(taps.second);
    return taps;
}

/// Magnitudes of edges and of points in lightness, per pixel. [ANA+20, section 4.2.1]
struct Features {
    Plane edges, points;
};

Plane magnitude(const Plane& x, const Plane& y) {
    Plane out(x.size());
    std::transform(x.begin(), x.end(), y.begin(), out.begin(),
                   [](float a, float b) { return std::sqrt(a * a + b * b); });
    return out;
}

Features find_features(const Planes& planes, float pixels_per_degree) {
    Plane lightness = planes.ycxcz[0];
    for (float& y : lightness) {
        y = (y + 16.0F) / 116.0F;
    }
    const FeatureTaps taps = feature_taps(pixels_per_degree);
    const auto filter = [&](const Taps& rows, const Taps& columns) {
        return separable(lightness, planes.width, planes.height, rows, columns);
    };
    return {magnitude(filter(taps.first, taps.gauss), filter(taps.gauss, taps.first)),
            magnitude(filter(taps.second, taps.gauss), filter(taps.gauss, taps.second))};
}

}  // namespace

double flip(const Image& a, const Image& b, Image* map, float pixels_per_degree) {
    GN_CHECK_EQ(a.width, b.width);
    GN_CHECK_EQ(a.height, b.height);
    GN_CHECK(a.channels >= 3 && b.channels >= 3 && pixels_per_degree > 0.0F);
    if (map != nullptr) {
        *map = Image(a.width, a.height, 1);
    }
    if (a.pixels() == 0) {
        return 0.0;
    }
    const Planes planes_a = opponent_planes(a);
    const Planes planes_b = opponent_planes(b);
    const std::vector<vec3> lab_a = perceived(planes_a, pixels_per_degree);
    const std::vector<vec3> lab_b = perceived(planes_b, pixels_per_degree);
    const Features features_a = find_features(planes_a, pixels_per_degree);
    const Features features_b = find_features(planes_b, pixels_per_degree);

    // A difference in features amplifies the one in colour. [ANA+20, section 4.3]
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        const float colour = redistributed(flip_color::hyab(lab_a[i], lab_b[i]));
        const float strongest = std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                                         std::abs(features_a.points[i] - features_b.points[i]));
        const float feature = std::min(std::pow(strongest / std::sqrt(2.0F), feature_exponent), 1.0F);
        const float error = std::pow(colour, 1.0F - feature);
        sum += static_cast<double>(error);
        if (map != nullptr) {
            map->values[i] = error;
        }
    }
    return sum / static_cast<double>(a.pixels());
}

}  // namespace gn
