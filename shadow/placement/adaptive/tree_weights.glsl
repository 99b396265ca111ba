// SPDX-License-Identifier: MIT
// What the demands in the nodes of one level weigh, their own and those of their children, and the finest level among them.
#include "shadow/placement/adaptive/tree_nodes.glsl"
layout(local_size_x = 256) in;

void main() {
    int within = int(gl_GlobalInvocationID.x);
    int side = 1 << u.level;
    if (within >= t.count * side * side) {
        return;
    }
    Node node = Node(within / (side * side), u.level, ivec2(within & (side - 1), (within % (side * side)) >> u.level));
    int at = gn_adaptive_node(t.data.levels, node.map, node.level, node.cell);
    float of_children = 0.0;
    int finest = own[at] > 0u ? node.level : 0;
    for (int i = 0; i < 4 && node.level < t.data.levels; ++i) {
        int child = child_of(node, i);
        of_children += weight[child];
#ifdef GN_TREE_GRID
        finest = max(finest, deepest[child]);
#endif
    }
    weight[at] = float(own[at]) + t.growth * of_children;
#ifdef GN_TREE_GRID
    deepest[at] = finest;
#endif
}
