// SPDX-License-Identifier: MIT
#include "shadow/geometry/masked_tree.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace gn::masked_tree_test {
namespace {

TEST(MaskedTree, holds_each_triangle_once_in_every_box_that_leads_to_it) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    for (const std::uint32_t count : {0U, 1U, 4U, 5U, 1000U}) {
        // A third of them lie on each other, which no plane parts.
        std::vector<vec3> positions;
        std::vector<uvec3> triangles;
        for (std::uint32_t i = 0; i < count; ++i) {
            for (int corner = 0; corner < 3; ++corner) {
                positions.push_back(i % 3 == 0 ? vec3(1, 2, corner) : vec3(unit(random), unit(random), unit(random)));
            }
            triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
        std::vector<std::uint32_t> all(count);
        std::iota(all.begin(), all.end(), 0U);
        const TriangleTree tree = build_tree(positions, triangles, all);
        std::vector<int> seen(count, 0);
        for (std::size_t at = 0; at < tree.nodes.size(); ++at) {
            // What a node holds are its triangles or those of the nodes up to the one behind it.
            const TreeNode& node = tree.nodes[at];
            EXPECT_GT(node.behind, at);
            EXPECT_EQ(node.held != 0, node.behind == at + 1);
            for (std::size_t leaf = at; leaf < node.behind; ++leaf) {
                const std::uint32_t first = tree.nodes[leaf].held / 8, held = tree.nodes[leaf].held % 8;
                for (std::uint32_t i = first; i < first + held; ++i) {
                    seen[tree.triangles[i]] += leaf == at ? 1 : 0;
                    for (int corner = 0; corner < 3; ++corner) {
                        EXPECT_TRUE(
                            Box(node.low_ws, node.high_ws).contains(positions[triangles[tree.triangles[i]][corner]]));
                    }
                }
            }
        }
        EXPECT_EQ(seen, std::vector<int>(count, 1));
        EXPECT_EQ(tree.nodes.empty(), count == 0);
        EXPECT_LE(tree.nodes.size(), count);
    }
}

}  // namespace
}  // namespace gn::masked_tree_test
