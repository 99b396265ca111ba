// SPDX-License-Identifier: MIT
// The view that draws a node's tile: its part of its map with a border all around, in a square of the atlas.

GnLightView view_of(Node node, int tile) {
    GnLightView view = t.maps[node.map];
    float part = exp2(-float(node.level));
    float scale = t.data.texels / (part * float(t.tile));
    vec2 middle = (2.0 * vec2(node.cell) + 1.0) * part - 1.0 - 2.0 * t.jitter / (float(t.tile) * scale);

    // x' = (x - middle w) scale, and back.
    for (int i = 0; i < 4; ++i) {
        vec4 column = t.maps[node.map].cs_from_ws[i];
        view.cs_from_ws[i] = vec4((column.xy - middle * column.w) * scale, column.zw);
    }
    view.ws_from_cs[0] = t.maps[node.map].ws_from_cs[0] / scale;
    view.ws_from_cs[1] = t.maps[node.map].ws_from_cs[1] / scale;
    view.ws_from_cs[3] = t.maps[node.map].ws_from_cs[3] + t.maps[node.map].ws_from_cs[0] * middle.x +
                         t.maps[node.map].ws_from_cs[1] * middle.y;

    int of_layer = t.across * t.across;
    ivec2 square = ivec2(tile % of_layer % t.across, tile % of_layer / t.across);
    view.rect_ts = vec4(vec2(square * t.tile), vec2(t.tile)) / float(t.resolution);
    view.resolution = float(t.resolution);
    view.layer = tile / of_layer;
    return view;
}
