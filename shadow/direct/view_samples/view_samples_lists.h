// SPDX-License-Identifier: MIT
// The view samples that count for a light, sorted by the texel of a light view that lists them, and a tree of boxes over them.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/direct/view_samples/view_samples.glsl"
#include "shadow/recipe/recipe.h"

#include <algorithm>

namespace gn {

/// Lists of texels, one behind the other as a Z curve runs through the views. A sample's place is where it stands in them.
struct SortedSamples {
    std::uint32_t pixels = 0;  ///< places that there are room for
    std::uint32_t trees = 0;   ///< each over 4^tree_levels places
    BufferHandle entries;  ///< uvec2 a pixel: its place + 1, 0 where no sample counts; the length of its texel's list
    BufferHandle points;   ///< uvec4 twice a place: bits of p_ws and the pixel's index, of n_ws and 0
    BufferHandle nodes;    ///< SampleNode: trees one behind the other, each node before its children
    BufferHandle used;     ///< a uint: places in use, the first ones
    static constexpr std::uint32_t tree_levels = 6;
    static constexpr std::uint32_t tree_places = 1U << (2 * tree_levels);
    static constexpr std::uint32_t tree_nodes = (4U << (2 * tree_levels)) / 3;
    static constexpr std::uint32_t node_bytes = 32;
    static constexpr std::uint32_t point_bytes = 32;  ///< a place
    /// Places whose lists and trees fit storage blocks of so many bytes.
    static constexpr std::uint64_t most_places(std::uint64_t block_bytes) {
        const std::uint64_t by_trees = block_bytes / (std::uint64_t{node_bytes} * tree_nodes) * tree_places;
        return std::min(by_trees, block_bytes / point_bytes);
    }
    /// GLSL of SampleNode: a box along the axes, the node behind all that it holds, and of leaves the place + 1.
    static constexpr const char* node_type =
        "struct SampleNode { vec3 low_ls; uint behind; vec3 high_ls; uint held; };\n";
};
SortedSamples add_sorted_samples(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                                 const glsl::GnLightAxes& axes);

}  // namespace gn
