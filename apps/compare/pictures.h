// SPDX-License-Identifier: MIT
// Pictures of errors.
#pragma once

#include "base/image.h"

#include <span>

namespace gn {

/// The colour of T - R in [-1,1]: dark where equal, blue where the technique is too dark (acne), amber where it is too
/// light (leaks). Magnitudes go through a square root, so that 0.01 still shows. sRGB-encoded.
vec3 error_color(float signed_error);

/// T - R per pixel through error_color; hatched grey where the sample does not count.
Image error_map(std::span<const float> signed_error, std::span<const std::uint8_t> counted, int width, int height);

/// The scale as a strip from -1 to 1, for the legend.
Image error_scale();

}  // namespace gn
