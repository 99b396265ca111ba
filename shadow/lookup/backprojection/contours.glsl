// SPDX-License-Identifier: MIT
// Outlines of connected texels that hide the light: only their edges are projected. Neighbours that touch at a corner are
// connected.
// Based on: Guennebaud, Barthe, Paulin. High-Quality Adaptive Soft Shadow Mapping. Computer Graphics Forum 2007. [GBP07]
// Departs from it: outlines run between the middles of the window's sides, so that they neither shrink nor grow what they enclose.
#ifndef GN_SHADOW_BACKPROJECTION_CONTOURS_GLSL
#define GN_SHADOW_BACKPROJECTION_CONTOURS_GLSL

#include "shadow/lookup/backprojection/cover.glsl"
#include "shadow/lookup/backprojection/texels.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// A window of 2 x 2 texels: a at (0,0), d at (1,0), c at (1,1), b at (0,1), as bits 1, 2, 4, 8 where they hide the light. Its
// sides are a-d 0, d-c 1, c-b 2, b-a 3. Of each case up to two edges from side to side, what hides on their left: start and end
// of the first, start and end of the second, two bits each, bits 8 and 9 say how many.
GN_FN uint gn_back_segments(int window) {
    const uint segments[16] = {0x000u, 0x10Cu, 0x101u, 0x10Du, 0x106u, 0x2E4u, 0x102u, 0x10Eu, 0x10Bu, 0x108u, 0x239u,
                                       0x109u, 0x107u, 0x104u, 0x103u, 0x000u};
    return segments[window];
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// What a host may fix when it compiles; left open, the parameters say it:
//   #define GN_BACK_COMBINE 0
#ifndef GN_BACK_COMBINE
#define GN_BACK_COMBINE params.combine
#endif

// The middle of a window's side, as deep as the one of its texels that hides the light.
vec2 gn_back_side(GnLookup at, GnBackMap map, vec2 corner, GnBackTexel one, GnBackTexel other) {
    return gn_back_corner(at, map, corner, one.hides ? one.depth : other.depth);
}

// Texels around those that are read hide nothing, so that outlines close.
GnBackTexel gn_back_within(GnLookup at, GN_BACK_MAPS, GnBackMap map, ivec2 texel, GnBackprojectionParams params) {
    GnBackTexel none;
    none.hides = false;
    bool within = all(greaterThanEqual(texel, map.texels.xy)) && all(lessThanEqual(texel, map.texels.zw));
    if (!within) {
        return none;
    }
    return gn_back_texel(at, GN_BACK_THESE, map, texel, params);
}

GnBackCover gn_back_contours(GnBackCover cover, GnLookup at, GN_BACK_MAPS, GnBackMap map, GnBackprojectionParams params) {
    GnBackCover outlines = gn_back_nothing();
    for (int y = map.texels.y - 1; y <= map.texels.w; ++y) {
        GnBackTexel a = gn_back_within(at, GN_BACK_THESE, map, ivec2(map.texels.x - 1, y), params);
        GnBackTexel b = a;
        for (int x = map.texels.x; x <= map.texels.z + 1; ++x) {
            GnBackTexel d = gn_back_within(at, GN_BACK_THESE, map, ivec2(x, y), params);
            GnBackTexel c = gn_back_within(at, GN_BACK_THESE, map, ivec2(x, y + 1), params);
            uint segments = gn_back_segments(int(a.hides) + 2 * int(d.hides) + 4 * int(c.hides) + 8 * int(b.hides));
            if (segments != 0u) {
                // The window's middle is the corner between its texels.
                vec2 sides[4];
                sides[0] = gn_back_side(at, map, vec2(x, float(y) + 0.5), a, d);
                sides[1] = gn_back_side(at, map, vec2(float(x) + 0.5, y + 1), d, c);
                sides[2] = gn_back_side(at, map, vec2(x, float(y) + 1.5), c, b);
                sides[3] = gn_back_side(at, map, vec2(float(x) - 0.5, y + 1), b, a);
                vec2 from = sides[segments & 3u];
                vec2 to = sides[segments >> 2 & 3u];
                bool two = (segments >> 8) > 1u;
                vec2 second_from = two ? sides[segments >> 4 & 3u] : to;
                vec2 second_to = two ? sides[segments >> 6 & 3u] : to;
                outlines = gn_back_outline(outlines, from, to, second_from, second_to, GN_BACK_COMBINE == GN_BACK_BITMASK,
                                           map.disc);
            }
            a = d;
            b = c;
        }
    }
    return gn_back_united(cover, outlines);
}
#endif

#endif
