// SPDX-License-Identifier: MIT
#include "base/image.h"

#include "base/error.h"

#include <cmath>

namespace gn {

Image::Image(int w, int h, int c, float fill) : width(w), height(h), channels(c) {
    GN_CHECK(w >= 0 && h >= 0 && c >= 0);
    values.assign(pixels() * static_cast<std::size_t>(c), fill);
}

float srgb_from_linear(float linear) {
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

float linear_from_srgb(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

}  // namespace gn
