// SPDX-License-Identifier: MIT
// The order in which squares are given away, empty ones first, then those unused for longest, and the order in which tiles are drawn
// anew: each lane adds some squares up in the order that the frame before left, then all lanes before it.
#include "shadow/placement/adaptive/tree_places.glsl"
layout(local_size_x = GN_TREE_LANES) in;
shared uvec4 of_lane[GN_TREE_LANES];

int place_at(int i) { return u.fresh != 0 ? i : int(GN_BEFORE(GN_PLACE_ROWS * GN_TREE_ROW + i)); }

// One for each that is drawn anew, empty, holds what nothing asks for, or is asked for.
uvec4 counted(int place) {
    uint state = GN_STATE(place);
    bool empty = GN_HOLDS(place) == 0u;
    return uvec4(state == GN_TREE_STALE, state == 0u && empty, state == 0u && !empty, state != 0u);
}

void main() {
    int lane = int(gl_LocalInvocationID.x);
    int each = (t.tiles + GN_TREE_LANES - 1) / GN_TREE_LANES;
    int first = lane * each;
    int end = min(first + each, t.tiles);
    uvec4 sum = uvec4(0u);
    for (int i = first; i < end; ++i) {
        sum += counted(place_at(i));
    }
    of_lane[lane] = sum;
    barrier();
    uvec4 before = uvec4(0u);
    uvec4 all = uvec4(0u);
    for (int i = 0; i < GN_TREE_LANES; ++i) {
        before += i < lane ? of_lane[i] : uvec4(0u);
        all += of_lane[i];
    }
    for (int i = first; i < end; ++i) {
        int place = place_at(i);
        uvec4 own = counted(place);
        GN_DRAW(place) = own.x != 0u ? before.x + 1u : 0u;
        if (own.y != 0u) {
            GN_VICTIM(before.y) = uint(place);
        } else if (own.z != 0u) {
            GN_VICTIM(all.y + before.z) = uint(place);
        } else {
            GN_VICTIM(all.y + all.z + before.w) = uint(place);
        }
        before += own;
    }
    if (lane == 0) {
        c.stale = all.x;
        c.held = all.w;
    }
}
