// SPDX-License-Identifier: MIT
// What a picture says about where a surface is: the alpha of formats that leave its meaning open.
#pragma once

#include "base/image.h"

#include <string>
#include <vector>

namespace gn {

/// What the alpha of a picture can be. Holes: some texels are there and some are not. Other: it varies, or is missing
/// everywhere, as gloss or height packed there do.
enum class AlphaUse { none, holes, other };
AlphaUse alpha_use(const Image8& image);

/// The alpha of `base` becomes the coverage of `mask`: its alpha where it has any, else its brightness. The larger of both
/// sizes stays, so that no hole is lost.
void merge_alpha(Image8& base, const Image8& mask);

/// Whether a material is a mask because its colour's alpha has holes, though no map of coverage says so; a note says what was
/// made of an alpha. `coverage` and `color` are what the format calls those maps.
bool mask_of_color(const Image8& image, const std::string& material, const char* coverage, const char* color,
                   std::vector<std::string>& notes);

}  // namespace gn
