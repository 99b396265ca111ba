// SPDX-License-Identifier: MIT
#include "shadow/geometry/masked_tree.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace gn {
namespace {

TEST(MaskedTree, holds_each_triangle_once_in_every_box_above_it) {
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
        std::size_t deepest = 0;
        const std::function<void(std::size_t, std::vector<std::size_t>)> visit = [&](std::size_t at, std::vector<std::size_t> above) {
            above.push_back(at);
            deepest = std::max(deepest, above.size());
            const TreeNode& node = tree.nodes[at];
            for (std::uint32_t i = 0; i < node.count; ++i) {
                const uvec3 t = triangles[tree.triangles[node.first + i]];
                ++seen[tree.triangles[node.first + i]];
                for (const std::size_t box : above) {
                    for (int corner = 0; corner < 3; ++corner) {
                        EXPECT_TRUE(Box(tree.nodes[box].low_ws, tree.nodes[box].high_ws).contains(positions[t[corner]]));
                    }
                }
            }
            if (node.count == 0) {
                visit(node.first, above);
                visit(node.first + 1, above);
            }
        };
        if (count > 0) {
            visit(0, {});
        }
        EXPECT_EQ(seen, std::vector<int>(count, 1));
        EXPECT_EQ(tree.nodes.empty(), count == 0);
        EXPECT_LE(deepest, 10U);
    }
}

}  // namespace
}  // namespace gn
