// SPDX-License-Identifier: MIT
// The passes that find, allocate and describe pages, all on the GPU.
#pragma once

#include "shadow/placement/virtual/virtual.h"
#include "shadow/placement/virtual/virtual_grid.h"

#include <algorithm>

namespace gn::virtual_pages {

/// What the passes are told.
struct PageJob {
    GnVirtualParams params;
    GnVirtualData data;
    Grid grid;
    std::vector<vec4> touched;  ///< touched_parts
    bool fresh = true;          ///< no page holds anything
    int page = 128;             ///< texels along a side, with its border
    int border = 2;             ///< texels
    int along = 1;              ///< pages along a side of the pool
    vec2 jitter{0};             ///< texels that pages are moved by
    float reach = 0;            ///< texels beyond a receiver whose pages are asked for, too
    std::uint32_t frame = 1;
    TextureHandle before, now;  ///< R32_UINT, a column a page: slot + 1 (0: none), tag, frame of the latest use
    [[nodiscard]] int pages() const { return along * along; }
    [[nodiscard]] int slots() const { return data.levels * data.faces * GN_VIRTUAL_SIDE * GN_VIRTUAL_SIDE; }
    /// Slots that pages can take: of a level as many as it has pages, or its window where that is smaller.
    [[nodiscard]] std::uint32_t most_listed() const {
        std::uint32_t of_face = 0;
        for (int level = 0; level < data.levels; ++level) {
            const auto side = static_cast<std::uint32_t>(std::min(1 << level, GN_VIRTUAL_SIDE));
            of_face += side * side;
        }
        return of_face * static_cast<std::uint32_t>(data.faces);
    }
};

/// What they give: buffers.
struct Pages {
    BufferHandle views;  ///< GnLightView of every page of the pool
    BufferHandle table;  ///< as gn_virtual_pages reads it
    BufferHandle drawn;  ///< GnLightView of those that this frame draws
    BufferHandle count;  ///< how many these are
};

Pages add_page_search(const FrameInput& input, const PageJob& job);

}  // namespace gn::virtual_pages
