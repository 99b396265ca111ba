// SPDX-License-Identifier: MIT
// Based on: Schwaerzler, Mattausch, Scherzer, Wimmer. Fast Accurate Soft Shadows with Adaptive Light Source Sampling. VMV 2012.
// [SMSW12]
#include "shadow/light/accumulate_adaptive/light_tree.h"

#include "base/error.h"
#include "base/sobol.h"

#include <map>

namespace gn {
namespace {

std::uint32_t cells_of(int level) {
    return 1U << (2U * static_cast<std::uint32_t>(level));
}

std::uint32_t side_of(int level) {
    return 1U << static_cast<std::uint32_t>(level);
}

/// Points of the cells of every level, by their number row by row.
std::vector<std::vector<std::uint32_t>> points_of(int levels) {
    std::vector<std::vector<std::uint32_t>> points;
    for (int level = 0; level <= levels; ++level) {
        const std::uint32_t side = side_of(level);
        std::vector<std::uint32_t>& of_level = points.emplace_back(cells_of(level), ~0U);
        for (std::uint32_t i = 0; i < cells_of(level); ++i) {
            const uvec2 cell = glm::min(uvec2(sobol_owen(i, 0) * static_cast<float>(side)), uvec2(side - 1));
            GN_CHECK(of_level[cell.y * side + cell.x] == ~0U);
            of_level[cell.y * side + cell.x] = i;
        }
    }
    return points;
}

struct Walk {
    const LightTree& tree;
    std::vector<std::vector<std::uint32_t>> points;
    std::vector<TreeLeaf> leaves;
    std::map<std::uint32_t, int> spoken;  ///< by divided cell, how many of its four parts did
};

void visit(Walk& walk, int level, uvec2 cell) {
    if (level < walk.tree.levels && walk.tree.divided[tree_cell(level, cell)]) {
        for (std::uint32_t i = 0; i < 4; ++i) {
            visit(walk, level + 1, 2U * cell + uvec2(i & 1U, i >> 1U));
        }
        return;
    }
    TreeLeaf leaf;
    leaf.point = walk.points[static_cast<std::size_t>(level)][cell.y * side_of(level) + cell.x];
    leaf.share = 1.0F / static_cast<float>(cells_of(level));
    for (int above = 0; above < level; ++above) {
        const uvec2 part = cell / side_of(level - above - 1);
        const auto parent = static_cast<std::uint32_t>(tree_cell(above, part / 2U));
        leaf.parents.push_back(parent);
        if (walk.points[static_cast<std::size_t>(above) + 1][part.y * side_of(above + 1) + part.x] == leaf.point) {
            const int before = walk.spoken[parent]++;
            const std::uint32_t bit = side_of(above);
            leaf.speaks |= bit;
            leaf.first |= before == 0 ? bit : 0;
            leaf.last |= before == 3 ? bit : 0;
        }
    }
    walk.leaves.push_back(std::move(leaf));
}

}  // namespace

std::size_t tree_cell(int level, uvec2 cell) {
    return (cells_of(level) - 1) / 3 + cell.y * side_of(level) + cell.x;
}

LightTree divided_to(int level, int levels) {
    LightTree tree{levels, std::vector<bool>((cells_of(levels) - 1) / 3, false)};
    for (std::size_t i = 0; i < (cells_of(std::min(level, levels)) - 1) / 3; ++i) {
        tree.divided[i] = true;
    }
    return tree;
}

LightTree refined(const SeenTree& seen, double least) {
    LightTree tree = divided_to(1, seen.tree.levels);
    for (int level = 1; level < tree.levels; ++level) {
        for (std::uint32_t i = 0; i < cells_of(level); ++i) {
            const uvec2 cell(i % side_of(level), i / side_of(level));
            const std::size_t parent = tree_cell(level - 1, cell / 2U);
            tree.divided[tree_cell(level, cell)] =
                tree.divided[parent] && seen.tree.divided[parent] && seen.disagree[parent] >= least;
        }
    }
    return tree;
}

std::vector<TreeLeaf> leaves_of(const LightTree& tree) {
    Walk walk{tree, points_of(tree.levels), {}, {}};
    visit(walk, 0, uvec2(0));
    return std::move(walk.leaves);
}

}  // namespace gn
