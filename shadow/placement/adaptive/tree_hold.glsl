// SPDX-License-Identifier: MIT
// What earlier frames left in the squares of the atlas: what of it is asked for again, and in what of it casters moved.
#include "shadow/placement/adaptive/tree_needed.glsl"
#include "shadow/placement/adaptive/tree_places.glsl"
#include "shadow/placement/adaptive/tree_view.glsl"
layout(local_size_x = 64) in;

// By the same test that a tile's casters are found by.
bool touched(GnLightView view) {
    for (int i = 0; i < u.boxes; ++i) {
        if (gn_tile_reached(view, boxes[2 * i].xyz, boxes[2 * i + 1].xyz)) {
            return true;
        }
    }
    return false;
}

void main() {
    int place = int(gl_GlobalInvocationID.x);
    if (place >= t.tiles) {
        return;
    }
    uint holds = u.fresh != 0 ? 0u : GN_BEFORE(place);
    int index = int(holds) - 1;
    bool moved = index >= 0 && touched(view_of(node_of(index), place));
    bool asked = index >= 0 && weight[index] > 0.0 && has_tile(index);
    GN_HOLDS(place) = moved && !asked ? 0u : holds;
    GN_STATE(place) = !asked ? 0u : moved || u.redrawn != 0 ? GN_TREE_STALE : GN_TREE_HELD;
    if (asked) {
        pages[index] = uint(place) + 1u;
    }
}
