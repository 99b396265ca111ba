// SPDX-License-Identifier: MIT
// Nodes of the tree as every pass sees them. Each node holds how many samples ask for its very level (`own`), what all demands
// in it weigh (`weight`), which is never less than what one of its children's do.

struct Node {
    int map;
    int level;
    ivec2 cell;
};

Node node_of(int index) {
    int all = gn_adaptive_before(t.data.levels + 1);
    int within = index % all;
    // 4^l <= 3 i + 1 < 4^(l+1) for the i-th node of a tree.
    int level = findMSB(uint(3 * within + 1)) / 2;
    int along = within - gn_adaptive_before(level);
    return Node(index / all, level, ivec2(along & ((1 << level) - 1), along >> level));
}

// The rank of a weight: eighths of a doubling from 1/16 on, by the bits of its exponent and the first of its fraction, so that what
// weighs more never ranks lower. 0: nothing asks.
int rank_of(float w) {
    const int first = 0x3D800000 >> 20;
    return w > 0.0 ? clamp((floatBitsToInt(w) >> 20) - first, 1, GN_TREE_RANKS - 1) : 0;
}

int child_of(Node node, int i) {
    return gn_adaptive_node(t.data.levels, node.map, node.level + 1, 2 * node.cell + ivec2(i & 1, i >> 1));
}
