// SPDX-License-Identifier: MIT
// FLIP: published properties and constants, and the whole against its definition with two-dimensional kernels.
#include "shadow/metrics/flip_color.h"
#include "shadow/metrics/metrics.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace gn::flip_test {
namespace {

constexpr float default_ppd = 67.0206F;

Image noise(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    Image image(width, height, 3);
    for (float& v : image.values) {
        v = unit(random);
    }
    return image;
}

Image mixed(const Image& a, const Image& b, float weight) {
    Image image = a;
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        image.values[i] += weight * (b.values[i] - a.values[i]);
    }
    return image;
}

Image solid(vec3 color, int size = 32) {
    Image image(size, size, 3);
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        image.values[i] = color[static_cast<int>(i % 3)];
    }
    return image;
}

TEST(Flip, EqualPicturesAreZero) {
    const Image image = noise(40, 30, 1);
    Image map;
    EXPECT_EQ(flip(image, image, &map), 0.0);
    EXPECT_EQ(map.values, std::vector<float>(image.pixels(), 0.0F));
}

TEST(Flip, Symmetric) {
    const Image a = noise(40, 30, 1);
    const Image b = noise(40, 30, 2);
    EXPECT_EQ(flip(a, b), flip(b, a));
}

TEST(Flip, BoundedByZeroAndOne) {
    const std::vector<vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                    {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    for (const vec3 a : corners) {
        for (const vec3 b : corners) {
            const double difference = flip(solid(a), solid(b));
            EXPECT_GE(difference, 0.0);
            EXPECT_LE(difference, 1.0);
        }
    }
    // Pure green and pure blue are the furthest apart of all, by definition.
    EXPECT_NEAR(flip(solid({0, 1, 0}), solid({0, 0, 1})), 1.0, 1e-4);
}

TEST(Flip, GrowsWithTheDifference) {
    const Image a = solid({0.4F, 0.5F, 0.3F});
    double last = 0;
    for (const float weight : {0.05F, 0.1F, 0.2F, 0.4F, 0.8F, 1.0F}) {
        const double difference = flip(a, mixed(a, solid({0.9F, 0.2F, 0.7F}), weight));
        EXPECT_GT(difference, last) << "weight " << weight;
        last = difference;
    }
    // A larger false region in a picture counts for more.
    const Image scene = noise(64, 64, 3);
    double last_area = 0;
    for (const int size : {4, 12, 30, 60}) {
        Image wrong = scene;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                wrong.at(x, y, 0) = 1 - wrong.at(x, y, 0);
            }
        }
        const double difference = flip(scene, wrong);
        EXPECT_GT(difference, last_area) << "size " << size;
        last_area = difference;
    }
}

TEST(Flip, FineNoiseVanishesAtADistance) {
    // What the eye cannot resolve is not seen: the same pictures from further away differ less.
    const Image a = noise(64, 64, 1);
    const Image b = noise(64, 64, 2);
    EXPECT_LT(flip(a, b, nullptr, 4 * default_ppd), flip(a, b));
    EXPECT_LT(flip(a, b), flip(a, b, nullptr, default_ppd / 4));
}

TEST(FlipColor, PublishedColours) {
    // CIE L*a*b* of the sRGB primaries under D65, as tabulated.
    using namespace flip_color;
    const auto lab = [](vec3 rgb) { return lab_from_xyz(xyz_from_linear(rgb)); };
    EXPECT_LT(glm::length(lab({1, 1, 1}) - vec3(100, 0, 0)), 1e-3F);
    EXPECT_LT(glm::length(lab({1, 0, 0}) - vec3(53.24F, 80.09F, 67.20F)), 0.05F);
    EXPECT_LT(glm::length(lab({0, 1, 0}) - vec3(87.73F, -86.18F, 83.18F)), 0.05F);
    EXPECT_LT(glm::length(lab({0, 0, 1}) - vec3(32.30F, 79.19F, -107.86F)), 0.05F);
    EXPECT_NEAR(lab_from_xyz(vec3(0.001F)).x, 0.9033F, 1e-4F);  // the linear toe: L* = 903.3 Y
    EXPECT_LT(glm::length(lab(vec3(0))), 1e-4F);
    // YCxCz equals L*a*b* at white and is linear: there and back is the identity.
    const vec3 rgb(0.2F, 0.7F, 0.4F);
    EXPECT_LT(glm::length(linear_from_xyz(xyz_from_ycxcz(ycxcz_from_xyz(xyz_from_linear(rgb)))) - rgb), 1e-5F);
    EXPECT_LT(glm::length(ycxcz_from_xyz(xyz_from_linear(vec3(1))) - vec3(100, 0, 0)), 1e-3F);
    EXPECT_LT(glm::length(hunt_adjusted({50, 20, -30}) - vec3(50, 10, -15)), 1e-5F);
    EXPECT_NEAR(largest_difference(), 41.276F, 5e-4F);
    EXPECT_FLOAT_EQ(hyab({10, 3, 4}, {20, 0, 0}), 15.0F);
}

/// FLIP as it is defined: every kernel built and applied in two dimensions, in double precision.
class Definition {
  public:
    Definition(const Image& image, double pixels_per_degree)
        : width_(image.width), height_(image.height), ppd_(pixels_per_degree) {
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            const float* c = image.values.data() + 3 * i;
            const vec3 linear(linear_from_srgb(c[0]), linear_from_srgb(c[1]), linear_from_srgb(c[2]));
            ycxcz_.emplace_back(flip_color::ycxcz_from_xyz(flip_color::xyz_from_linear(linear)));
        }
    }
    using Kernel = std::function<double(double x, double y)>;

    /// Correlates one channel; the positive weights and the negative weights each sum to one in magnitude.
    [[nodiscard]] double filtered(int px, int py, int channel, int radius, const Kernel& kernel) const {
        double positive = 0;
        double negative = 0;
        double positive_weight = 0;
        double negative_weight = 0;
        for (int dy = -radius; dy <= radius; ++dy) {
            for (int dx = -radius; dx <= radius; ++dx) {
                const double weight = kernel(dx, dy);
                const int x = std::clamp(px + dx, 0, width_ - 1);
                const int y = std::clamp(py + dy, 0, height_ - 1);
                const double value = ycxcz_[static_cast<std::size_t>(y * width_ + x)][channel];
                (weight > 0 ? positive : negative) += weight * value;
                (weight > 0 ? positive_weight : negative_weight) += std::abs(weight);
            }
        }
        return positive / positive_weight + (negative_weight > 0 ? negative / negative_weight : 0.0);
    }
    [[nodiscard]] vec3 perceived(int x, int y) const {
        const double pi2 = std::numbers::pi * std::numbers::pi;
        const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi2)) * ppd_));
        const auto gauss = [&](double a, double b, double dx, double dy) {
            return a * std::sqrt(std::numbers::pi / b) * std::exp(-pi2 * (dx * dx + dy * dy) / (ppd_ * ppd_) / b);
        };
        const vec3 blurred(filtered(x, y, 0, radius, [&](double dx, double dy) { return gauss(1, 0.0047, dx, dy); }),
                           filtered(x, y, 1, radius, [&](double dx, double dy) { return gauss(1, 0.0053, dx, dy); }),
                           filtered(x, y, 2, radius, [&](double dx, double dy) {
                               return gauss(34.1, 0.04, dx, dy) + gauss(13.5, 0.025, dx, dy);
                           }));
        const vec3 rgb = glm::clamp(flip_color::linear_from_xyz(flip_color::xyz_from_ycxcz(blurred)), 0.0F, 1.0F);
        return flip_color::hunt_adjusted(flip_color::lab_from_xyz(flip_color::xyz_from_linear(rgb)));
    }
    /// Edge (order 1) or point (order 2) magnitude of lightness.
    [[nodiscard]] double feature(int x, int y, int order) const {
        const double sigma = 0.5 * 0.082 * ppd_;
        const int radius = static_cast<int>(std::ceil(3 * sigma));
        const auto derivative = [&](double along, double across) {
            const double g = std::exp(-(along * along + across * across) / (2 * sigma * sigma));
            return (order == 1 ? -along : along * along / (sigma * sigma) - 1.0) * g;
        };
        const double fx = filtered(x, y, 0, radius, derivative);
        const double fy = filtered(x, y, 0, radius, [&](double dx, double dy) { return derivative(dy, dx); });
        return std::hypot(fx, fy) / 116.0;
    }

  private:
    int width_, height_;
    double ppd_;
    std::vector<dvec3> ycxcz_;
};

TEST(Flip, SeparableFiltersGiveTheDefinition) {
    const Image a = noise(28, 20, 5);
    const Image b = mixed(a, noise(28, 20, 6), 0.3F);
    Image map;
    (void)flip(a, b, &map);
    const Definition da(a, static_cast<double>(default_ppd));
    const Definition db(b, static_cast<double>(default_ppd));
    const double largest = static_cast<double>(flip_color::largest_difference());
    for (int y = 0; y < a.height; y += 3) {
        for (int x = 0; x < a.width; x += 3) {
            const double d =
                std::pow(static_cast<double>(flip_color::hyab(da.perceived(x, y), db.perceived(x, y))), 0.7);
            const double colour =
                d < 0.4 * largest ? 0.95 / (0.4 * largest) * d : 0.95 + (d - 0.4 * largest) / (0.6 * largest) * 0.05;
            const double strongest = std::max(std::abs(da.feature(x, y, 1) - db.feature(x, y, 1)),
                                              std::abs(da.feature(x, y, 2) - db.feature(x, y, 2)));
            EXPECT_NEAR(static_cast<double>(map.at(x, y)),
                        std::pow(colour, 1.0 - std::sqrt(strongest / std::sqrt(2.0))), 2e-4)
                << "pixel " << x << ", " << y;
        }
    }
}

}  // namespace
}  // namespace gn::flip_test
