// SPDX-License-Identifier: MIT
// What is made of a map for those who ask for it by name. A pyramid of least and greatest depths, and N-buffers, which
// answer for any square of 2^l texels and not only for aligned ones; planes before all depths of a block;
// shadow/receiver/map_range.glsl reads them. Sums over rectangles: sums.glsl. Mips. The surfaces one behind the other: shadow/casters/peel.h.
//
// Based on: Decoret. N-Buffers for Efficient Depth Map Query. Computer Graphics Forum 2005. [Dec05]
#pragma once

#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

namespace gn {

/// RG32F, as large as `depth`, all mips: x the least and y the greatest depth of the 2^l x 2^l texels under a texel of
/// level l. Where a side is odd, the last texel of the next level covers three of its texels, so that none is left out.
/// `depth`: a 2D array, one sample; its layers stay. Without its first levels where `first` is above 0: level l is then of
/// 2^(l + first) texels, and is made of the depths at once.
TextureHandle add_min_max_pyramid(FrameGraph& graph, TextureHandle depth, std::uint32_t first = 0);

/// RGBA32F, the pyramid of blocks of 8 x 8 texels and of larger ones: a plane before all depths of a block, x its depth at the
/// block's first texel, y and z what it grows by from texel to texel. Of a flat surface, slanted or not, it is that surface.
TextureHandle add_lower_planes(FrameGraph& graph, TextureHandle depth);

enum class NBuffer {
    min_max,  ///< RG32F: least and greatest
    ranges,   ///< the same of a source that has both already
    mean,     ///< the components' means, in the source's own format
};
/// Level l of layer v is layer v * levels + l: at texel t, over the square of 2^l texels that begins at t and goes to the
/// right and down, clamped to the map. `levels` is the return value's layers over the source's: 1 + floor(log2(side)),
/// at most `most_levels`. Of the source's level `mip`. Throws Error where the device has too few layers.
TextureHandle add_n_buffer(FrameGraph& graph, TextureHandle source, NBuffer kind, std::uint32_t most_levels = 16,
                           std::uint32_t mip = 0);

/// Fills the mips of every layer by halving boxes; the device must filter the format.
void add_mips(FrameGraph& graph, TextureHandle texture);
/// A copy of the source's first level, in its own format (R32F of a depth) with all mips, filled by add_mips. Lookups read it
/// by shadow/receiver/map_mean.glsl, which keeps to the receiver's view where several share a layer.
TextureHandle add_mipmapped(FrameGraph& graph, TextureHandle source);

/// What a derivation is made of.
struct DerivedFrom {
    const FrameInput& input;
    const Recipe& recipe;
    const LightViews& views;
    TextureHandle source;
    int count = 0;
};
/// What can be made of a texture that a map gives, for lookups that name it in `needs`.
struct Derivation {
    std::string_view name;      ///< "min-max"
    std::string_view from;      ///< "depth"
    std::string_view contents;  ///< one sentence
    int most = 0;               ///< above 0: lookups ask for up to so many, "peeled-4"
    bool filters = false;       ///< needs a device that filters the source's format
    TextureHandle (*add)(const DerivedFrom&) = nullptr;
};
std::span<const Derivation> derivations();
/// Adds to the map's offers what the recipe's lookup needs and the map does not give itself: once, however many read it.
/// Throws Refusal where the device cannot make it.
void add_derived(const FrameInput& input, const Recipe& recipe, const LightViews& views, ShadowMap& map);

/// Levels that add_n_buffer makes for a map of this side.
std::uint32_t n_buffer_levels(std::uint32_t side, std::uint32_t most_levels = 16);

}  // namespace gn
