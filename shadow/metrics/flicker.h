// SPDX-License-Identifier: MIT
// Flicker: how T - R changes at points of the scene while a camera moves along a path.
//
// A point that a pixel of one frame shows is found again in the next frame by projection. T - R has edges, and comparing
// it at two points on either side of one would be taken for a change over time although nothing changed. Therefore only
// those pairs count whose second sample's pixel centre lies within a sixteenth of a pixel of where the first sample's
// point is projected: that leaves one sample in eighty, enough for a mean, and an edge of T - R is mistaken for a change
// at one in twenty of its pixels. Pixels in between are not interpolated, which would blur the edges of one frame only.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gn {

/// Largest distance between a projected point and the centre of the pixel that it is compared with, pixels.
inline constexpr float flicker_offset = 1.0F / 16;

/// Where one frame of a path saw which points.
struct PathView {
    int width = 0, height = 0;
    mat4 cs_from_ws{1};                 ///< of the camera; rows of pixels run with y in clip space
    float pixel_size = 0;               ///< side of a pixel at one metre along the view axis, metres
    std::span<const vec4> position_ws;  ///< per pixel; w = 1 where a surface is seen
};

/// For every pixel of `from` the pixel of `to` that shows the same point, or -1. The point is the same when the pixel's
/// centre is near enough, see above, and what it shows lies no farther from the point than a pixel's width there: of one
/// surface that holds unless it is seen at less than 3.6 degrees; two surfaces so close are one to the eye.
std::vector<int> same_points(const PathView& from, const PathView& to, float offset = flicker_offset);

/// T - R of one light in one frame.
struct SignedError {
    std::vector<float> values;
    std::vector<std::uint8_t> counted;  ///< 1 where the sample counts
};
/// A T that is not a number counts as wholly wrong.
SignedError signed_error(std::span<const float> technique, std::span<const float> reference,
                         std::span<const std::uint8_t> counted);

/// Sums of squared changes; those of several steps or lights add up.
struct Flicker {
    std::size_t samples = 0;
    double squares = 0;
    Flicker& operator+=(const Flicker& more);
    [[nodiscard]] std::optional<double> root_mean_square() const;  ///< absent without samples
};
/// Over the pairs of `same` that count in both frames.
Flicker flicker_between(const SignedError& from, const SignedError& to, std::span<const int> same);

}  // namespace gn
