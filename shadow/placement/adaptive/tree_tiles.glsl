// SPDX-License-Identifier: MIT
// The page of every node, and the view that draws it in the next square of the atlas. Where tiles are kept, of those alone that no
// square holds yet, in the squares that are given away.
#include "shadow/placement/adaptive/tree_needed.glsl"
#ifdef GN_TREE_KEPT
#include "shadow/placement/adaptive/tree_places.glsl"
#else
#include "shadow/placement/adaptive/tree_view.glsl"
#endif
layout(local_size_x = 64) in;

// The page of a node that has a tile and, where tiles are kept, none yet; `tile`: of how many such nodes it is the last.
uint place_tile(int index, uint tile) {
#ifdef GN_TREE_KEPT
    uint place = GN_VICTIM(tile);
    GN_HOLDS(place) = uint(index) + 1u;
    GN_STATE(place) = GN_TREE_HELD;
    GN_DRAW(place) = c.stale + tile + 1u;
    return place + 1u;
#else
    views[tile] = view_of(node_of(index), int(tile));
    return tile + 1u;
#endif
}

void main() {
    int block = int(gl_GlobalInvocationID.x);
    if (block >= t.blocks) {
        return;
    }
    int end = min((block + 1) * GN_TREE_BLOCK, t.nodes);
    uint tile = in_block[block];
    for (int index = block * GN_TREE_BLOCK; index < end; ++index) {
        bool there = weight[index] > 0.0 && has_tile(index);
#ifdef GN_TREE_KEPT
        if (!there || pages[index] != 0u) {
            continue;
        }
#endif
        pages[index] = there ? place_tile(index, tile) : 0u;
        tile += there ? 1u : 0u;
    }
}
