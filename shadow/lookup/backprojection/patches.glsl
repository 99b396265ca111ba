// SPDX-License-Identifier: MIT
// Texels as patches at their own depth, across the view. Gaps between neighbours of different depth are closed by walls.
// Based on: Guennebaud, Barthe, Paulin. Real-time Soft Shadow Mapping by Backprojection. EGSR 2006. [GBP06]
// Patches of variable size: Schwarz, Stamminger. Quality Scalability of Soft Shadow Mapping. Graphics Interface 2008. [SS08b]
// Departs from them: a wall stands between the edges of two patches, where they stretch a patch towards its neighbour; it leaves
// no gap towards the diagonal neighbour.
#ifndef GN_SHADOW_BACKPROJECTION_PATCHES_GLSL
#define GN_SHADOW_BACKPROJECTION_PATCHES_GLSL

#include "shadow/lookup/backprojection/cover.glsl"
#include "shadow/lookup/backprojection/texels.glsl"

#ifndef __cplusplus
// What a host may fix when it compiles; left open, the parameters say it:
//   #define GN_BACK_OCCLUDER 0
//   #define GN_BACK_COMBINE 0
#ifndef GN_BACK_OCCLUDER
#define GN_BACK_OCCLUDER params.occluder
#endif
#ifndef GN_BACK_COMBINE
#define GN_BACK_COMBINE params.combine
#endif

// The wall from corner to corner of the map, between a patch and the texel beside it.
GnBackCover gn_back_wall(GnBackCover cover, GnLookup at, GnBackMap map, vec4 edge, float depth, GnBackTexel beside,
                         GnBackprojectionParams params) {
    float step = abs(depth - beside.depth) * at.projected.metres_per_depth;
    if (!beside.hides || (params.gap_limit > 0.0 && step > params.gap_limit)) {
        return cover;
    }
    return gn_back_hide(cover, gn_back_corner(at, map, edge.xy, depth), gn_back_corner(at, map, edge.zw, depth),
                        gn_back_corner(at, map, edge.zw, beside.depth), gn_back_corner(at, map, edge.xy, beside.depth),
                        GN_BACK_COMBINE == GN_BACK_BITMASK, map.disc);
}

// Where in its texel a patch lies, least and greatest corner: everywhere, or around those of the four finer texels that hide the
// light where rectangles fit them.
vec4 gn_back_patch(GnLookup at, GN_BACK_MAPS, GnBackMap map, ivec2 texel, GnBackprojectionParams params) {
    vec4 whole = vec4(vec2(texel), vec2(texel + 1));
    if (GN_BACK_OCCLUDER != GN_BACK_MICRORECT || map.level == 0) {
        return whole;
    }
    GnBackMap finer = map;
    finer.level -= 1;
    vec4 fitted = vec4(1.0e9, 1.0e9, -1.0e9, -1.0e9);
    for (int k = 0; k < 4; ++k) {
        ivec2 part = 2 * texel + ivec2(k & 1, k >> 1);
        if (gn_back_texel(at, GN_BACK_THESE, finer, part, params).hides) {
            fitted = vec4(min(fitted.xy, 0.5 * vec2(part)), max(fitted.zw, 0.5 * vec2(part + 1)));
        }
    }
    return fitted.x <= fitted.z ? fitted : whole;
}

// All texels, and the walls to the neighbours on the left and below.
GnBackCover gn_back_patches(GnBackCover cover, GnLookup at, GN_BACK_MAPS, GnBackMap map, GnBackprojectionParams params) {
    for (int y = map.texels.y; y <= map.texels.w; ++y) {
        GnBackTexel left;
        left.hides = false;
        for (int x = map.texels.x; x <= map.texels.z; ++x) {
            GnBackTexel own = gn_back_texel(at, GN_BACK_THESE, map, ivec2(x, y), params);
            if (own.hides) {
                vec4 extent = gn_back_patch(at, GN_BACK_THESE, map, ivec2(x, y), params);
                cover = gn_back_hide(cover, gn_back_corner(at, map, extent.xy, own.depth),
                                     gn_back_corner(at, map, extent.xw, own.depth),
                                     gn_back_corner(at, map, extent.zw, own.depth),
                                     gn_back_corner(at, map, extent.zy, own.depth),
                                     GN_BACK_COMBINE == GN_BACK_BITMASK, map.disc);
                if (params.gaps != 0 && extent.x == float(x)) {
                    cover = gn_back_wall(cover, at, map, extent.xyxw, own.depth, left, params);
                }
                if (params.gaps != 0 && extent.y == float(y) && y > map.texels.y) {
                    GnBackTexel below = gn_back_texel(at, GN_BACK_THESE, map, ivec2(x, y - 1), params);
                    cover = gn_back_wall(cover, at, map, extent.xyzy, own.depth, below, params);
                }
            }
            left = own;
        }
    }
    return cover;
}
#endif

#endif
