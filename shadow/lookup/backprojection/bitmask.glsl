// SPDX-License-Identifier: MIT
// Which of 256 points of the light are hidden, one bit each: polygons are united without error where they overlap.
// Based on: Schwarz, Stamminger. Bitmask Soft Shadows. Computer Graphics Forum 2007. [SS07]
// Departs from it: masks of polygons instead of rectangles, found row by row by arithmetic; points that share a column or a row
// are moved apart within it, so that an edge along the light's axes takes 256 values and not 32.
#ifndef GN_SHADOW_BACKPROJECTION_BITMASK_GLSL
#define GN_SHADOW_BACKPROJECTION_BITMASK_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The light is the square [-1,1]^2. It holds 8 x 8 tiles of the four points of a rotated grid (RGSS), so 32 rows of 8 points.
// Row k stands in word k / 4; bit c of a word is a point in column c of 32.
struct GnBackMask {
    uvec4 low;  // words 0 to 3
    uvec4 high;
};

// The column, within a tile, of row k's points: 1, 3, 0, 2 for the four rows of a tile.
GN_FN uint gn_back_column(int k) { return (0x8Du >> uint(2 * (k & 3))) & 3u; }

// How far the points of row k lie beside their columns' middles, in columns: another eighth for each row of tiles.
GN_FN float gn_back_aside(int k) {
    return (float((0xEE9CA0u >> uint(3 * (k >> 2))) & 7u) + 0.5f) / 8.0f - 0.5f;
}

// Rows rise by one row from the light's left to its right.
const float gn_back_rise = 1.0f / 32.0f;

// A point of the light where rows lie level: y is the row's own.
GN_FN vec2 gn_back_level(vec2 x) { return vec2(x.x, x.y - gn_back_rise * x.x); }

// Where the point in column c of row k lies on the light.
GN_FN vec2 gn_back_sample(int k, int c) {
    float x = (float(c) + 0.5f + gn_back_aside(k)) / 16.0f - 1.0f;
    return vec2(x, (float(k) + 0.5f) / 16.0f - 1.0f + gn_back_rise * x);
}

// Bits of the columns of row k that lie to the right of x.
GN_FN uint gn_back_right_of(float x, float aside) {
    int n = int(clamp(floor(16.0f * x + 15.5f - aside) + 1.0f, 0.0f, 32.0f));
    return n > 31 ? 0u : 0xFFFFFFFFu << uint(n);
}

GN_FN uvec4 gn_back_word(uint bits, int word) {
    return uvec4(word == 0 ? bits : 0u, word == 1 ? bits : 0u, word == 2 ? bits : 0u, word == 3 ? bits : 0u);
}

GN_FN GnBackMask gn_back_no_mask() {
    GnBackMask mask;
    mask.low = uvec4(0u);
    mask.high = uvec4(0u);
    return mask;
}

// Four edges of the light, from (x0, y0) to (x1, y1) each, where rows lie level. What lies to the right of an odd number of
// edges is toggled: of closed polygons their inside. `unite`: what was hidden stays hidden. An edge is the same number from
// both of its ends, so that no point slips through between neighbours.
GN_FN GnBackMask gn_back_toggled(GnBackMask mask, vec4 x0, vec4 y0, vec4 x1, vec4 y1, bool unite) {
    bvec4 rises = lessThanEqual(y0, y1);
    vec4 low_x = mix(x1, x0, rises);
    vec4 low_y = mix(y1, y0, rises);
    vec4 high_y = mix(y0, y1, rises);
    vec4 slope = (mix(x0, x1, rises) - low_x) / max(high_y - low_y, vec4(1.0e-30f));
    float lowest = min(min(low_y.x, low_y.y), min(low_y.z, low_y.w));
    float highest = max(max(high_y.x, high_y.y), max(high_y.z, high_y.w));
    int first = int(clamp(ceil(16.0f * lowest + 15.5f), 0.0f, 32.0f));
    int end = int(clamp(ceil(16.0f * highest + 15.5f), 0.0f, 32.0f));
    for (int k = first; k < end; ++k) {
        float y = (float(k) + 0.5f) / 16.0f - 1.0f;
        float aside = gn_back_aside(k);
        vec4 x = low_x + (y - low_y) * slope;
        uint bits = low_y.x <= y && y < high_y.x ? gn_back_right_of(x.x, aside) : 0u;
        bits ^= low_y.y <= y && y < high_y.y ? gn_back_right_of(x.y, aside) : 0u;
        bits ^= low_y.z <= y && y < high_y.z ? gn_back_right_of(x.z, aside) : 0u;
        bits ^= low_y.w <= y && y < high_y.w ? gn_back_right_of(x.w, aside) : 0u;
        bits &= 0x11111111u << gn_back_column(k);
        uvec4 low = gn_back_word(bits, k >> 2);
        uvec4 high = gn_back_word(bits, (k >> 2) - 4);
        mask.low = unite ? mask.low | low : mask.low ^ low;
        mask.high = unite ? mask.high | high : mask.high ^ high;
    }
    return mask;
}

// The points of a disc that fills the square.
const uvec4 gn_back_disc_low = uvec4(0x05dffd00u, 0x1ffffff0u, 0x7ffffffcu, 0xffffffffu);
const uvec4 gn_back_disc_high = uvec4(0xffffffffu, 0x3ffffffeu, 0x0ffffff8u, 0x00bffba0u);

// The share of the light's points that are hidden.
GN_FN float gn_back_share(GnBackMask mask, bool disc) {
    uvec4 low = disc ? mask.low & gn_back_disc_low : mask.low;
    uvec4 high = disc ? mask.high & gn_back_disc_high : mask.high;
    ivec4 counts = bitCount(low) + bitCount(high);
    return float(counts.x + counts.y + counts.z + counts.w) / (disc ? 204.0f : 256.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
