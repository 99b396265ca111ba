// SPDX-License-Identifier: MIT
// Every tile of a uniform grid has one resolution, in proportion to the samples in it, and no finer than any of them asks for: of
// what lies in it all nodes of a level have one weight, a quarter from level to level, since they are four times as many.
#include "shadow/placement/adaptive/tree_nodes.glsl"
layout(local_size_x = 256) in;

void main() {
    int index = int(gl_GlobalInvocationID.x);
    if (index >= t.nodes) {
        return;
    }
    Node node = node_of(index);
    int finer = node.level - t.grid;
    if (finer <= 0) {
        return;
    }
    int tile = gn_adaptive_node(t.data.levels, node.map, t.grid, node.cell >> finer);
    bool there = node.level <= deepest[tile];
    weight[index] = there ? weight[tile] * exp2(-2.0 * float(finer)) : 0.0;
}
