// SPDX-License-Identifier: MIT
// Tiles before every block: each lane adds some blocks up, then all lanes before it.
layout(local_size_x = GN_TREE_LANES) in;
shared uint of_lane[GN_TREE_LANES];

void main() {
    int lane = int(gl_LocalInvocationID.x);
    int each = (t.blocks + GN_TREE_LANES - 1) / GN_TREE_LANES;
    int first = lane * each;
    int end = min(first + each, t.blocks);
    uint sum = 0u;
    for (int block = first; block < end; ++block) {
        sum += in_block[block];
    }
    of_lane[lane] = sum;
    barrier();
    uint before = 0u;
    for (int i = 0; i < lane; ++i) {
        before += of_lane[i];
    }
    for (int block = first; block < end; ++block) {
        uint tiles = in_block[block];
        in_block[block] = before;
        before += tiles;
    }
    if (lane == GN_TREE_LANES - 1) {
        count = c.stale + before;
        c.used = c.held + before;
    }
}
