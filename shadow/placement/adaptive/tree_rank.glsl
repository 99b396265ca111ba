// SPDX-License-Identifier: MIT
// The lowest rank of which all tiles fit the budget.
layout(local_size_x = 1) in;

void main() {
    int tiles = 0;
    c.rank = 0;
    for (int lowest = 1; lowest <= GN_TREE_RANKS; ++lowest) {
        tiles += c.begins[lowest];
        if (lowest == 1) {
            c.wanted = uint(tiles);
        }
        if (tiles <= t.tiles) {
            c.rank = lowest;
            break;
        }
    }
}
