// SPDX-License-Identifier: MIT
// Tiles of every block of nodes, where tiles are kept those that are not there yet, and samples whose texels are larger than a pixel.
#include "shadow/placement/adaptive/tree_needed.glsl"
layout(local_size_x = 64) in;

// Whether the budget gives those who ask for a node texels that are larger than a pixel.
bool too_coarse(int index) {
    Node node = node_of(index);
    int level = max(node.level - t.spare, 0);
    int enough = gn_adaptive_node(t.data.levels, node.map, level, node.cell >> (node.level - level));
    return level > 0 && rank_of(weight[enough]) < c.rank;
}

void main() {
    int block = int(gl_GlobalInvocationID.x);
    if (block >= t.blocks) {
        return;
    }
    int end = min((block + 1) * GN_TREE_BLOCK, t.nodes);
    uint tiles = 0u;
    uint coarser = 0u;
    for (int index = block * GN_TREE_BLOCK; index < end; ++index) {
        if (weight[index] > 0.0) {
            bool there = has_tile(index);
#ifdef GN_TREE_KEPT
            there = there && pages[index] == 0u;
#endif
            tiles += there ? 1u : 0u;
            coarser += own[index] > 0u && too_coarse(index) ? own[index] : 0u;
        }
    }
    in_block[block] = tiles;
    if (coarser > 0u) {
        atomicAdd(c.coarser, coarser);
    }
}
