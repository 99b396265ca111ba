// SPDX-License-Identifier: MIT
// Where exact methods may differ from the reference by rounding alone.
//
// An exact method asks the same question about the same points, so it can only differ where a point lies within
// rounding of a shadow's border. Such a border runs between pixel centres: R jumps within the pixel's 3 x 3
// neighbourhood. A hard shadow marks the pixels on both sides of the jump, diagonal neighbours included. A soft one is
// marked where its ramp is as narrow as a pixel, R spanning one half or more over two pixels, wherever between 0 and 1
// the middle falls. Pixels that do not count have no R: a silhouette or a turn away from the light is no discontinuity.
#include "base/error.h"
#include "shadow/metrics/metrics.h"

#include <algorithm>

namespace gn {

std::vector<std::uint8_t> edge_pixels(std::span<const float> reference, std::span<const std::uint8_t> counted,
                                      int width, int height) {
    GN_CHECK(width >= 0 && height >= 0);
    const auto stride = static_cast<std::size_t>(width);
    GN_CHECK_EQ(reference.size(), stride * static_cast<std::size_t>(height));
    GN_CHECK_EQ(counted.size(), reference.size());
    std::vector<std::uint8_t> edges(reference.size(), 0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x);
            if (counted[pixel] == 0) {
                continue;
            }

            // Span R over the counted neighbours.
            float low = reference[pixel];
            float high = low;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
                    const std::size_t i = static_cast<std::size_t>(v) * stride + static_cast<std::size_t>(u);
                    if (counted[i] != 0) {
                        low = std::min(low, reference[i]);
                        high = std::max(high, reference[i]);
                    }
                }
            }
            edges[pixel] = high - low >= 0.5F ? 1 : 0;
        }
    }
    return edges;
}

}  // namespace gn
