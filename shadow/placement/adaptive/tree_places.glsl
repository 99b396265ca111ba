// SPDX-License-Identifier: MIT
// What every square of the atlas holds: 1 + a node, 0 nothing; whether this frame asks for it; 1 + where in the frame's list of
// tiles to be drawn it is, 0 where it is not drawn; and all squares in the order in which they are given away.

#define GN_HOLDS(place) places[place]
#define GN_STATE(place) places[t.tiles + int(place)]
#define GN_DRAW(place) places[2 * t.tiles + int(place)]
#define GN_VICTIM(i) places[3 * t.tiles + int(i)]

// Asked for as it is; asked for, and drawn anew; else nothing asks.
const uint GN_TREE_HELD = 1u;
const uint GN_TREE_STALE = 2u;

// The rows of the texture that outlives the frame which tell what squares hold; behind them those that tell their order, the one
// unused for longest first.
#define GN_PLACE_ROWS ((t.tiles + GN_TREE_ROW - 1) / GN_TREE_ROW)
