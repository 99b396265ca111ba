// SPDX-License-Identifier: MIT
// A quad tree over a light's surface. The first 4^k points of a (0,2)-sequence lie one in each of its 4^k cells of level k, so
// that a cell keeps its point when it is divided, and all cells of a level are the points that `accumulate` takes.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <vector>

namespace gn {

/// Levels of the deepest tree.
inline constexpr int most_tree_levels = 5;

/// Which cells are divided, by tree_cell.
struct LightTree {
    int levels = 1;  ///< cells of this level are never divided
    std::vector<bool> divided;
};
/// The number of a cell of a level, (x, y) of 2^level a side, among the cells of all levels above the last.
std::size_t tree_cell(int level, uvec2 cell);
/// A tree whose cells above `level` are divided.
LightTree divided_to(int level, int levels);

/// What a frame saw: of each divided cell the view samples whose V its four parts do not agree about.
struct SeenTree {
    LightTree tree;
    std::vector<std::uint32_t> disagree;  ///< by tree_cell
};
/// The tree of the next frame: the light's own four parts, and the parts of each cell whose four parts at least `least` samples
/// disagreed about. [SMSW12]
LightTree refined(const SeenTree& seen, double least);

/// A cell that is not divided: what a shadow is drawn for.
struct TreeLeaf {
    std::uint32_t point = 0;  ///< of the sequence
    float share = 1;          ///< of the light
    /// Bits, one a level from that of the light's own parts: whether the V of this leaf's point speaks for the cell of that
    /// level that it lies in, among the four that one cell was divided into; whether it is the first or the last of the four.
    std::uint32_t speaks = 0, first = 0, last = 0;
    std::vector<std::uint32_t> parents;  ///< by level, the cell that was divided: tree_cell
};
/// The leaves, so ordered that the parts of a cell follow each other, whatever they are divided into.
std::vector<TreeLeaf> leaves_of(const LightTree& tree);

}  // namespace gn
