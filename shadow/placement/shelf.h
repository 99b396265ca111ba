// SPDX-License-Identifier: MIT
// Squares of several sizes in the layers of one texture.
#pragma once

#include "shadow/light_view.h"

#include <cstdint>

namespace gn {

/// Places squares, largest first, along a Z-shaped curve: each then starts at a multiple of its own size.
struct Shelf {
    int most = 0;            ///< halvings of the smallest square
    std::uint32_t next = 0;  ///< in smallest squares
    /// Sets the layer and the rectangle of a square of so many halvings.
    void put(GnLightView& view, int halved) {
        const std::uint32_t in_layer = 1U << (2 * most);
        view.layer = static_cast<int>(next / in_layer);
        const std::uint32_t along = next % in_layer;
        uvec2 cell(0);
        for (unsigned bit = 0; bit < static_cast<unsigned>(most); ++bit) {
            cell.x |= (along >> (2 * bit) & 1U) << bit;
            cell.y |= (along >> (2 * bit + 1) & 1U) << bit;
        }
        const float unit = 1.0F / static_cast<float>(1U << most);
        const float side = 1.0F / static_cast<float>(1U << halved);
        view.rect_ts = vec4(static_cast<float>(cell.x) * unit, static_cast<float>(cell.y) * unit, side, side);
        next += 1U << (2 * (most - halved));
    }
};

}  // namespace gn
