// SPDX-License-Identifier: MIT
#include "shadow/scene/files/coverage.h"

#include "base/error.h"
#include "shadow/scene/model.h"

#include <algorithm>

namespace gn {
namespace {

/// Texels nearer than this to 0 or 1 are a hole, or there: what scaling and lossy packing leave of an edge lies between.
constexpr std::uint8_t hole = 8, there = 247;

std::size_t index_of(const Image8& image, int x, int y) {
    return 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
}

// The texel of `image` that lies under texel (x, y) of a picture of width x height.
const std::uint8_t* texel_under(const Image8& image, int x, int y, int width, int height) {
    const auto at = [](int i, int from, int to) { return static_cast<int>(static_cast<std::int64_t>(i) * to / from); };
    return &image.rgba[index_of(image, at(x, width, image.width), at(y, height, image.height))];
}

}  // namespace

AlphaUse alpha_use(const Image8& image) {
    bool any = false, holes = false, solid = false;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        any = any || image.rgba[i] != 255;
        holes = holes || image.rgba[i] <= hole;
        solid = solid || image.rgba[i] >= there;
    }
    return !any ? AlphaUse::none : holes && solid ? AlphaUse::holes : AlphaUse::other;
}

void merge_alpha(Image8& base, const Image8& mask) {
    const bool has_alpha = alpha_use(mask) != AlphaUse::none;
    Image8 merged{std::max(base.width, mask.width), std::max(base.height, mask.height), {}};
    merged.rgba.resize(index_of(merged, 0, merged.height));
    for (int y = 0; y < merged.height; ++y) {
        for (int x = 0; x < merged.width; ++x) {
            std::uint8_t* to = &merged.rgba[index_of(merged, x, y)];
            const std::uint8_t* cover = texel_under(mask, x, y, merged.width, merged.height);
            std::copy_n(texel_under(base, x, y, merged.width, merged.height), 3, to);
            to[3] = has_alpha ? cover[3] : std::max({cover[0], cover[1], cover[2]});
        }
    }
    base = std::move(merged);
}

bool mask_of_color(const Image8& image, const std::string& material, const char* coverage, const char* color,
                   std::vector<std::string>& notes) {
    const AlphaUse use = alpha_use(image);
    if (use == AlphaUse::holes) {
        add_note(notes,
                 fmt::format("Material '{}' has no {}, and holes in the alpha of its {}: they are read as holes.",
                             material, coverage, color));
    } else if (use == AlphaUse::other) {
        add_note(notes, fmt::format("Material '{}' has no {}, and an alpha in its {} that is no mask: it is ignored.",
                                    material, coverage, color));
    }
    return use == AlphaUse::holes;
}

}  // namespace gn
