// SPDX-License-Identifier: MIT
// Summed-area tables: how sums are stored, and the mean of any box of texels from the corners of a table.
// Compiles as GLSL and as C++.
// Based on: Lauritzen. Summed-Area Variance Shadow Maps. GPU Gems 3, 2007. [Lau07]
#ifndef GN_SHADOW_MAP_SUMS_GLSL
#define GN_SHADOW_MAP_SUMS_GLSL

#include "base/shared.h"
#include "shadow/map/sums_params.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Steps of a moment in an integer table. Sums may wrap around; a box's difference is right as long as the box's own
// sum is below 2^32, which bounds the steps by the largest box. Rounding a float to the nearest step needs one of its 24 bits.
GN_FN float gn_sat_levels(int max_box) {
    return float(min(0xffffffffu / uint(max_box * max_box), 0x7fffffu));
}

GN_FN uvec2 gn_sat_quantize(vec2 moments, float levels) {
    return uvec2(uint(clamp(moments.x, 0.0f, 1.0f) * levels + 0.5f), uint(clamp(moments.y, 0.0f, 1.0f) * levels + 0.5f));
}

// A float table sums differences from these, which keeps the sums, and so their rounding, small. [Lau07] 8.4.1
GN_FN vec4 gn_sat_centre() { return vec4(0.5f, 0.375f, 0.0f, 0.0f); }

// A pair of 32-bit integers in four 16-bit shares of one.
GN_FN vec4 gn_sat_pack(uvec2 sums) {
    return vec4(float(sums.x >> 16u), float(sums.x & 65535u), float(sums.y >> 16u), float(sums.y & 65535u)) / 65535.0f;
}

GN_FN uvec2 gn_sat_unpack(vec4 packed) {
    vec4 halves = packed * 65535.0f + 0.5f;
    return uvec2(uint(halves.x) * 65536u + uint(halves.y), uint(halves.z) * 65536u + uint(halves.w));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Sum of all texels before `corner`.
vec4 gn_sat_fetch(sampler2DArray table, ivec2 corner, int layer) {
    return min(corner.x, corner.y) == 0 ? vec4(0.0) : texelFetch(table, ivec3(corner - 1, layer), 0);
}

// Mean of the texels [x.x, x.y) by [y.x, y.y): four corners of a table of this kind. An integer table has two components,
// and answers for boxes up to `max_box` texels wide.
vec4 gn_sat_mean(sampler2DArray table, int kind, int max_box, int layer, ivec2 x, ivec2 y) {
    vec4 a = gn_sat_fetch(table, ivec2(x.y, y.y), layer);
    vec4 b = gn_sat_fetch(table, ivec2(x.x, y.y), layer);
    vec4 c = gn_sat_fetch(table, ivec2(x.y, y.x), layer);
    vec4 d = gn_sat_fetch(table, ivec2(x.x, y.x), layer);
    float area = float((x.y - x.x) * (y.y - y.x));
    if (kind == GN_SAT_FLOAT32) {
        return (a - b - c + d) / area + gn_sat_centre();
    }
    uvec2 sum = gn_sat_unpack(a) - gn_sat_unpack(b) - gn_sat_unpack(c) + gn_sat_unpack(d);
    return vec4(vec2(sum) / (area * gn_sat_levels(max_box)), 0.0, 0.0);
}

#endif
#endif
