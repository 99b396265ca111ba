// SPDX-License-Identifier: MIT
// Flicker: how T - R changes at points of the scene while a camera moves along a path.
//
// A point that a pixel of one frame shows is found again in the next frame by projection. T - R has edges, and comparing
// it at two points on either side of one would be taken for a change over time although nothing changed. Two rules keep
// that floor low. Only those pairs count whose second sample's pixel centre lies within 1/32 of a pixel of where the
// first sample's point is projected: one sample in 326, enough for a mean; a step of T is then mistaken for a change at
// one in 75 of its pixels. And samples within one pixel of a discontinuity of R are left out, as when exact methods are
// judged. Pixels in between are not interpolated: that would blur the steps of one frame only.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gn {

/// Largest distance between a projected point and the centre of the pixel that it is compared with, pixels.
inline constexpr float flicker_offset = 1.0F / 32;
/// Least cosine between the normals of two samples of one surface: 8 degrees.
inline constexpr float flicker_alike = 0.99F;

/// Where one frame of a path saw which points.
struct PathView {
    int width = 0, height = 0;
    mat4 cs_from_ws{1};                 ///< of the camera; rows of pixels run with y in clip space
    float pixel_size = 0;               ///< side of a pixel where a point's w in clip space is 1, metres
    std::span<const vec4> normal_ws;    ///< geometric, xyz
    std::span<const vec4> position_ws;  ///< per pixel; w = 1 where a surface is seen
};

/// For every pixel of `from` the pixel of `to` that shows the same point, or -1. The point is the same when the pixel's
/// centre is near enough, see above, and what it shows lies no farther from the point than a pixel's width there: of one
/// surface that holds unless it is seen at less than 1.8 degrees; two surfaces so close are one to the eye.
std::vector<int> same_points(const PathView& from, const PathView& to, float offset = flicker_offset);

/// T - R of one light in one frame.
struct SignedError {
    std::vector<float> values;
    std::vector<std::uint8_t> counted;  ///< 1 where the sample counts and R is no edge
};
/// Samples within one pixel of a discontinuity of R do not count. A T that is not a number counts as wholly wrong.
SignedError signed_error(std::span<const float> technique, std::span<const float> reference,
                         std::span<const std::uint8_t> counted, int width, int height);

/// Sums of squared changes; those of several steps or lights add up.
struct Flicker {
    std::size_t samples = 0;
    double squares = 0;
    double fourths = 0;  ///< fourth powers
    Flicker& operator+=(const Flicker& more);
    [[nodiscard]] std::optional<double> root_mean_square() const;  ///< absent without samples
    /// By how many changes it is told: all of them where all are alike, 1 where a single one is all there is; 0 without change.
    [[nodiscard]] double told_by() const;
};
/// Over the pairs of `same` that count in both frames.
Flicker flicker_between(const SignedError& from, const SignedError& to, std::span<const int> same);

}  // namespace gn
