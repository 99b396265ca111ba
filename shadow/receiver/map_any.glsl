// SPDX-License-Identifier: MIT
// Whether a rectangle of texels holds a depth beyond a bound: exact, wherever the pyramid's own grid lies.
// Based on: Guennebaud, Barthe, Paulin. Real-time Soft Shadow Mapping by Backprojection. EGSR 2006. [GBP06], the hierarchical
// shadow map.
// Departs from it: squares that the rectangle cuts are divided, down to texels, where they could decide otherwise than what of
// them lies in it.
#ifndef GN_SHADOW_RECEIVER_MAP_ANY_GLSL
#define GN_SHADOW_RECEIVER_MAP_ANY_GLSL

#include "shadow/receiver/map_range.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The first and the last part of a square along one axis on the next finer level: two, or three where it is the last of its
// level and the finer one's side is odd.
GN_FN ivec2 gn_pyramid_parts(int square, int edge, int finer_edge) {
    return ivec2(2 * square, square == edge ? finer_edge : 2 * square + 1);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Whether any texel from `first` to `last` lies at `bounds.x` or farther (x), and whether any lies before `bounds.y` (y), in one walk.
// `pyramid` begins with texels; the rectangle lies in its layer.
bvec2 gn_pyramid_beyond(sampler2DArray pyramid, ivec2 first, ivec2 last, int layer, vec2 bounds) {
    // Corners tell most of where an edge crosses the rectangle.
    bvec2 found = bvec2(false);
    for (int k = 0; k < 4; ++k) {
        ivec2 corner = ivec2((k & 1) == 0 ? first.x : last.x, (k & 2) == 0 ? first.y : last.y);
        vec2 range = texelFetch(pyramid, ivec3(corner, layer), 0).xy;
        found = bvec2(found.x || range.y >= bounds.x, found.y || range.x < bounds.y);
    }

    ivec2 side = textureSize(pyramid, 0).xy;
    int top = gn_pyramid_level(first, last, textureQueryLevels(pyramid));
    ivec2 top_edge = max(side >> top, ivec2(1)) - 1;
    ivec2 root_first = min(first >> top, top_edge);
    ivec2 root_last = min(last >> top, top_edge);
    ivec2 root = root_first;
    int level = top;
    ivec2 square = root;
    while (!all(found)) {
        // What lies beyond a bound is found where the square lies in the rectangle, and looked for where it is cut.
        ivec2 edge = max(side >> level, ivec2(1)) - 1;
        ivec2 low = square << level;
        ivec2 high = ivec2(square.x == edge.x ? side.x : (square.x + 1) << level, square.y == edge.y ? side.y : (square.y + 1) << level) - 1;
        bool meets = all(lessThanEqual(low, last)) && all(greaterThanEqual(high, first));
        vec2 range = texelFetch(pyramid, ivec3(square, layer), level).xy;
        bvec2 beyond = bvec2(meets && !found.x && range.y >= bounds.x, meets && !found.y && range.x < bounds.y);
        bool whole = level == 0 || (all(greaterThanEqual(low, first)) && all(lessThanEqual(high, last)));
        if (any(beyond) && !whole) {
            --level;
            square *= 2;
            continue;
        }
        found = bvec2(found.x || beyond.x, found.y || beyond.y);

        // On to the next part of the same square, or to what follows that.
        bool moved = false;
        while (level < top && !moved) {
            ivec2 coarser_edge = max(side >> (level + 1), ivec2(1)) - 1;
            ivec2 parent = min(square >> 1, coarser_edge);
            edge = max(side >> level, ivec2(1)) - 1;
            ivec2 across = gn_pyramid_parts(parent.x, coarser_edge.x, edge.x);
            ivec2 up = gn_pyramid_parts(parent.y, coarser_edge.y, edge.y);
            if (square.x < across.y) {
                ++square.x;
                moved = true;
            } else if (square.y < up.y) {
                square = ivec2(across.x, square.y + 1);
                moved = true;
            } else {
                square = parent;
                ++level;
            }
        }
        if (!moved) {
            if (root.x < root_last.x) {
                ++root.x;
            } else if (root.y < root_last.y) {
                root = ivec2(root_first.x, root.y + 1);
            } else {
                break;
            }
            square = root;
        }
    }
    return found;
}
#endif

#endif
