// SPDX-License-Identifier: MIT
// The view of every square of the atlas, empty where nothing asks for what it holds; those to be drawn; and what the next frame finds.
#include "shadow/placement/adaptive/tree_nodes.glsl"
#include "shadow/placement/adaptive/tree_places.glsl"
#include "shadow/placement/adaptive/tree_view.glsl"
layout(local_size_x = 64) in;

void main() {
    int place = int(gl_GlobalInvocationID.x);
    if (place >= t.tiles) {
        return;
    }
    uint holds = GN_HOLDS(place);
    imageStore(now, ivec2(place % GN_TREE_ROW, place / GN_TREE_ROW), uvec4(holds));
    // Squares that got a tile now are used now: they stand first, and go behind all others.
    uint next = GN_VICTIM((place + int(c.used - c.held)) % t.tiles);
    imageStore(now, ivec2(place % GN_TREE_ROW, GN_PLACE_ROWS + place / GN_TREE_ROW), uvec4(next));
    GnLightView view = view_of(node_of(max(int(holds) - 1, 0)), place);
    view.rect_ts = GN_STATE(place) == 0u ? vec4(0.0) : view.rect_ts;
    views[place] = view;
    uint draw = GN_DRAW(place);
    if (draw != 0u) {
        drawn[draw - 1u] = view;
    }
}
