// SPDX-License-Identifier: MIT
// From which rank on nodes have tiles is what the budget decides. A node then has one where its rank suffices and some sample
// asks for its level, or for a finer one that has no tile.
#include "shadow/placement/adaptive/tree_nodes.glsl"

// The node needs a tile while the lowest rank with tiles is above x and at most y; a whole map's always, for what nothing finer
// serves.
ivec2 needed(int index) {
    Node node = node_of(index);
    if (node.level == 0) {
        return ivec2(0, GN_TREE_RANKS);
    }
    bool leaves = t.data.leaves != 0;
    bool asked = leaves ? node.level == t.data.levels : own[index] > 0u;
    int above = asked ? 0 : GN_TREE_RANKS;
    for (int i = 0; i < 4 && above > 0 && node.level < t.data.levels; ++i) {
        // Where the finest tile serves all, a part without one needs this node's.
        int child = rank_of(weight[child_of(node, i)]);
        above = child > 0 || leaves ? min(above, child) : above;
    }
    return ivec2(above, rank_of(weight[index]));
}

bool has_tile(int index) {
    ivec2 range = needed(index);
    return weight[index] > 0.0 && range.x < c.rank && c.rank <= range.y;
}
