// SPDX-License-Identifier: MIT
// Based on: Reinhard, Stark, Shirley, Ferwerda. Photographic Tone Reproduction for Digital Images. SIGGRAPH 2002. [RSSF02]
#include "shadow/shading/tonemap.h"

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

float luminance(const float* rgb) {
    return 0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2];
}

/// Linear up to 0.6, then a shoulder that reaches 1 only at infinity; value and slope are continuous.
float shoulder(float x) {
    constexpr float knee = 0.6F;
    return x <= knee ? x : knee + (1 - knee) * (1 - std::exp(-(x - knee) / (1 - knee)));
}

}  // namespace

float automatic_exposure(const Image& radiance) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < radiance.pixels(); ++i) {
        const float y = luminance(&radiance.values[i * static_cast<std::size_t>(radiance.channels)]);
        if (std::isfinite(y) && y > 0) {
            sum += std::log(static_cast<double>(y));
            ++count;
        }
    }
    // [RSSF02] eq. 1 and 2: the log-average becomes middle grey.
    return count == 0 ? 1.0F : static_cast<float>(0.18 / std::exp(sum / static_cast<double>(count)));
}

Image tonemap(const Image& radiance, float exposure) {
    Image display(radiance.width, radiance.height, 3);
    for (std::size_t i = 0; i < radiance.pixels(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float value = exposure * radiance.values[i * static_cast<std::size_t>(radiance.channels) + c];
            display.values[3 * i + c] = srgb_from_linear(std::isfinite(value) ? shoulder(std::max(value, 0.0F)) : 0.0F);
        }
    }
    return display;
}

}  // namespace gn
