// SPDX-License-Identifier: MIT
// From radiance to a picture one can look at: exposure, tone curve, sRGB.
#pragma once

#include "base/image.h"

namespace gn {

/// The exposure (1 / (cd/m^2)) that puts the picture's log-average luminance at middle grey. Pixels that are zero or
/// not finite are left out; 1 for a black picture.
float automatic_exposure(const Image& radiance);
/// Display-ready values in [0,1], sRGB-encoded, RGB.
Image tonemap(const Image& radiance, float exposure);

}  // namespace gn
