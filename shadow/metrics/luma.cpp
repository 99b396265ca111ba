// SPDX-License-Identifier: MIT
// Based on: Maarten van Sambeek. Real-time Shadow Generation for 3D simulations using modern hardware. Master's thesis,
// University of Twente 2007. [Sam07]
#include "base/error.h"
#include "shadow/metrics/metrics.h"

#include <cmath>

namespace gn {

double luma_rms(const Image& a, const Image& b) {
    GN_CHECK_EQ(a.width, b.width);
    GN_CHECK_EQ(a.height, b.height);
    GN_CHECK(a.channels >= 3 && b.channels >= 3);
    double squares = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            // Rec. 601: Y' = 0.299 R' + 0.587 G' + 0.114 B', linear, so the difference comes first.
            const auto difference = [&](int c) {
                return static_cast<double>(a.at(x, y, c)) - static_cast<double>(b.at(x, y, c));
            };
            const double luma = 255.0 * (0.299 * difference(0) + 0.587 * difference(1) + 0.114 * difference(2));
            squares += luma * luma;
        }
    }
    return a.pixels() == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(a.pixels()));
}

}  // namespace gn
