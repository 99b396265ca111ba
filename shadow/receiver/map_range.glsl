// SPDX-License-Identifier: MIT
// Least and greatest depth of a rectangle of texels, or a plane before all of its depths, from what shadow/map/derived.h makes.
// Texels are counted within the layer, both ends included.
// Based on: Decoret. N-Buffers for Efficient Depth Map Query. Computer Graphics Forum 2005. [Dec05]
#ifndef GN_SHADOW_RECEIVER_MAP_RANGE_GLSL
#define GN_SHADOW_RECEIVER_MAP_RANGE_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The finest level of a pyramid at which a rectangle lies in at most 2 x 2 texels.
GN_FN int gn_pyramid_level(ivec2 first, ivec2 last, int levels) {
    // Sides of 2^k and more texels lie in three of level k at most, and in two of the next.
    ivec2 side = last - first;
    int level = findMSB(max(max(side.x, side.y), 1));
    ivec2 apart = (last >> level) - (first >> level);
    return min(level + (max(apart.x, apart.y) > 1 ? 1 : 0), levels - 1);
}

// The level of a pyramid that coarse N-buffers are made of, and that block pyramids begin with: blocks of 8 texels.
const int gn_coarse_mip = 3;

// The level of a whole pyramid that the first one of this pyramid is, by the sides of the map and of that level.
GN_FN int gn_pyramid_first(int map_side, int side) {
    return findMSB(max(map_side / side, 1));
}

// Of a plane before all depths of a block, vec3(depth at its first texel, slopes a texel), the depth at another texel that a plane
// of the slopes `slope` may have there and still lie before them: the block begins `ahead` texels after that one, and its last
// texel lies `extent` after its first.
GN_FN float gn_lower_depth(vec3 block, vec2 ahead, vec2 extent, vec2 slope) {
    vec2 steeper = vec2(block.y, block.z) - slope;
    return block.x - dot(slope, ahead) + dot(min(steeper, vec2(0.0f)), extent);
}

// The texels from the first to the last of block `at` of the blocks of `side` texels up to `edge`, which takes in what is left over.
GN_FN vec2 gn_block_extent(ivec2 at, ivec2 edge, int side) {
    return vec2(float(at.x == edge.x ? 2 * side - 1 : side - 1), float(at.y == edge.y ? 2 * side - 1 : side - 1));
}

// The level of an N-buffer whose squares, one in each corner, cover a rectangle without a gap: the largest power of two
// that is no longer than the longer side.
GN_FN int gn_n_buffer_level(ivec2 first, ivec2 last, int levels) {
    return min(findMSB(max(max(last.x - first.x, last.y - first.y) + 1, 1)), levels - 1);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// A superset of the rectangle: what up to 2 x 2 texels of the pyramid cover.
vec2 gn_pyramid_min_max(sampler2DArray pyramid, ivec2 first, ivec2 last, int layer, int levels) {
    int level = gn_pyramid_level(first, last, levels);
    // Of a level that differs from pixel to pixel some drivers give one pixel's size to all: shift the whole map's.
    ivec2 edge = max(textureSize(pyramid, 0).xy >> level, ivec2(1)) - 1;
    ivec2 a = min(first >> level, edge);
    ivec2 b = min(last >> level, edge);
    vec2 aa = texelFetch(pyramid, ivec3(a, layer), level).xy;
    vec2 ba = texelFetch(pyramid, ivec3(b.x, a.y, layer), level).xy;
    vec2 ab = texelFetch(pyramid, ivec3(a.x, b.y, layer), level).xy;
    vec2 bb = texelFetch(pyramid, ivec3(b, layer), level).xy;
    return vec2(min(min(aa.x, ba.x), min(ab.x, bb.x)), max(max(aa.y, ba.y), max(ab.y, bb.y)));
}

// A plane before all depths of the rectangle: vec3(depth at its first texel, slopes a texel).
vec3 gn_lower_plane(sampler2DArray planes, ivec2 first, ivec2 last, int layer) {
    int level = gn_pyramid_level(first >> gn_coarse_mip, last >> gn_coarse_mip, textureQueryLevels(planes));
    int shift = gn_coarse_mip + level;
    ivec2 edge = max(textureSize(planes, 0).xy >> level, ivec2(1)) - 1;
    ivec2 a = min(first >> shift, edge);
    ivec2 b = min(last >> shift, edge);
    vec3 aa = texelFetch(planes, ivec3(a, layer), level).xyz;
    vec3 ba = texelFetch(planes, ivec3(b.x, a.y, layer), level).xyz;
    vec3 ab = texelFetch(planes, ivec3(a.x, b.y, layer), level).xyz;
    vec3 bb = texelFetch(planes, ivec3(b, layer), level).xyz;
    vec2 slope = 0.25 * ((aa.yz + ba.yz) + (ab.yz + bb.yz));
    int side = 1 << shift;
    vec2 near = vec2(a * side - first);
    vec2 far = vec2(b * side - first);
    vec2 extent = gn_block_extent(b, edge, side);
    float depth = min(min(gn_lower_depth(aa, near, extent, slope), gn_lower_depth(ba, vec2(far.x, near.y), extent, slope)),
                      min(gn_lower_depth(ab, vec2(near.x, far.y), extent, slope), gn_lower_depth(bb, far, extent, slope)));
    return vec3(depth, slope);
}

// Of the whole layer, whatever views it holds.
vec2 gn_pyramid_all(sampler2DArray pyramid, int layer) { return texelFetch(pyramid, ivec3(0, 0, layer), textureQueryLevels(pyramid) - 1).xy; }

// Exact for squares; along a shorter side the squares reach beyond the rectangle by what the sides differ.
vec2 gn_n_buffer_min_max(sampler2DArray squares, ivec2 first, ivec2 last, int layer, int levels) {
    int level = gn_n_buffer_level(first, last, levels);
    int index = layer * levels + level;
    ivec2 end = max(last - (1 << level) + 1, first);
    vec2 aa = texelFetch(squares, ivec3(first, index), 0).xy;
    vec2 ba = texelFetch(squares, ivec3(end.x, first.y, index), 0).xy;
    vec2 ab = texelFetch(squares, ivec3(first.x, end.y, index), 0).xy;
    vec2 bb = texelFetch(squares, ivec3(end, index), 0).xy;
    return vec2(min(min(aa.x, ba.x), min(ab.x, bb.x)), max(max(aa.y, ba.y), max(ab.y, bb.y)));
}
#endif

#endif
