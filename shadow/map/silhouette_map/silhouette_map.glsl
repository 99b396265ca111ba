// SPDX-License-Identifier: MIT
// What a silhouette map's cell stores: a point of a silhouette within it, packed into one float.
// Based on: Sen, Cammarano, Hanrahan. Shadow Silhouette Maps. SIGGRAPH 2003. [SCH03]
//
// Cells are the texels of a grid shifted by half a texel: the corners of cell (i, j) are the centres of the depth texels
// (i, j) to (i + 1, j + 1). Cell space (_cell) is [0,1]^2 within a cell.
#ifndef GN_SHADOW_MAP_SILHOUETTE_MAP_GLSL
#define GN_SHADOW_MAP_SILHOUETTE_MAP_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Twelve bits a coordinate: a 32-bit float holds 24 exactly.
GN_FN float gn_silhouette_pack(vec2 p_cell) {
    vec2 steps = floor(clamp(p_cell, vec2(0.0f), vec2(1.0f)) * 4095.0f + 0.5f);
    return steps.x * 4096.0f + steps.y;
}

GN_FN vec2 gn_silhouette_unpack(float packed) {
    float x = floor(packed / 4096.0f);
    return vec2(x, packed - x * 4096.0f) / 4095.0f;
}

GN_FN bool gn_silhouette_within(vec2 p_cell) {
    return p_cell.x >= 0.0f && p_cell.x <= 1.0f && p_cell.y >= 0.0f && p_cell.y <= 1.0f;
}

// Where the segment from a to b meets the zero line of a linear function with these values at a and b: its share of the
// way, or -1.
GN_FN float gn_silhouette_crossing(vec2 a_cell, vec2 b_cell, float at_a, float at_b) {
    if (at_a * at_b > 0.0f || at_a == at_b) {
        return -1.0f;
    }
    float t = at_a / (at_a - at_b);
    return gn_silhouette_within(mix(a_cell, b_cell, t)) ? t : -1.0f;
}

// [SCH03] 4.1: the point of a segment that stands for it in the cell, as its share of the way from a to b: an end of
// the segment within the cell, else its crossing with a diagonal, with both the middle between them. -1: the segment
// misses the cell.
GN_FN float gn_silhouette_point(vec2 a_cell, vec2 b_cell) {
    if (gn_silhouette_within(a_cell)) {
        return 0.0f;
    }
    if (gn_silhouette_within(b_cell)) {
        return 1.0f;
    }
    float rising = gn_silhouette_crossing(a_cell, b_cell, a_cell.y - a_cell.x, b_cell.y - b_cell.x);
    float falling =
        gn_silhouette_crossing(a_cell, b_cell, a_cell.x + a_cell.y - 1.0f, b_cell.x + b_cell.y - 1.0f);
    return rising >= 0.0f && falling >= 0.0f ? 0.5f * (rising + falling) : max(rising, falling);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
