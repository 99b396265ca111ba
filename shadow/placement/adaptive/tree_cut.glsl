// SPDX-License-Identifier: MIT
// How many tiles each choice of a lowest rank needs: every node adds one where its range begins and takes it off behind its end.
#include "shadow/placement/adaptive/tree_needed.glsl"
layout(local_size_x = 256) in;

void main() {
    int index = int(gl_GlobalInvocationID.x);
    if (index >= t.nodes || weight[index] == 0.0) {
        return;
    }
    ivec2 range = needed(index);
    if (range.x < range.y) {
        atomicAdd(c.begins[range.x + 1], 1);
        if (range.y < GN_TREE_RANKS) {
            atomicAdd(c.begins[range.y + 1], -1);
        }
    }
}
