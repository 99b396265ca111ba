// SPDX-License-Identifier: MIT
// The centres of four texels, or the corners of one, as a quad where all four hide the light; three of them as a triangle.
// Based on: Schwarz, Stamminger. Bitmask Soft Shadows. Computer Graphics Forum 2007. [SS07]
// Triangles: Schwarz, Stamminger. Microquad Soft Shadow Mapping Revisited. Eurographics 2008 (Short Papers). [SS08]
// Departs from them: corners between texels, so that neither are casters half a texel too narrow nor are thin ones missed.
#ifndef GN_SHADOW_BACKPROJECTION_QUADS_GLSL
#define GN_SHADOW_BACKPROJECTION_QUADS_GLSL

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

// Corners in turn around the cell.
GnBackCover gn_back_quad(GnBackCover cover, GnLookup at, GnBackTexel a, GnBackTexel b, GnBackTexel c, GnBackTexel d, GnBackMap map,
                         GnBackprojectionParams params) {
    int count = int(a.hides) + int(b.hides) + int(c.hides) + int(d.hides);
    if (count < (GN_BACK_OCCLUDER == GN_BACK_MICROTRI ? 3 : 4)) {
        return cover;
    }
    // A step that is too deep is a gap between two casters.
    float nearest = min(min(a.depth, b.depth), min(c.depth, d.depth));
    float farthest = max(max(a.depth, b.depth), max(c.depth, d.depth));
    if (params.gap_limit > 0.0 && count == 4 && (farthest - nearest) * at.projected.metres_per_depth > params.gap_limit) {
        return cover;
    }
    // The corner that is missing moves to the next one.
    return gn_back_hide(cover, a.hides ? a.seen : b.seen, b.hides ? b.seen : c.seen, c.hides ? c.seen : d.seen,
                        d.hides ? d.seen : a.seen, GN_BACK_COMBINE == GN_BACK_BITMASK, map.disc);
}

// A quad's corner: the centre of a texel, or the corner between four where the map's own texels count.
GnBackTexel gn_back_vertex(GnLookup at, GN_BACK_MAPS, GnBackMap map, ivec2 vertex, GnBackprojectionParams params) {
    if (GN_BACK_CORNERS != 0 && map.level == 0) {
        return gn_back_between_four(at, GN_BACK_THESE, map, vertex, params);
    }
    return gn_back_texel(at, GN_BACK_THESE, map, vertex, params);
}

// Row by row; what is read of a column serves two cells.
GnBackCover gn_back_quads(GnBackCover cover, GnLookup at, GN_BACK_MAPS, GnBackMap map, GnBackprojectionParams params) {
    ivec2 first = map.texels.xy + (GN_BACK_CORNERS != 0 && map.level == 0 ? 1 : 0);
    for (int y = first.y; y < map.texels.w; ++y) {
        GnBackTexel a;
        GnBackTexel b;
        a.hides = false;
        b.hides = false;
        for (int x = first.x; x <= map.texels.z; ++x) {
            GnBackTexel d = gn_back_vertex(at, GN_BACK_THESE, map, ivec2(x, y), params);
            GnBackTexel c = gn_back_vertex(at, GN_BACK_THESE, map, ivec2(x, y + 1), params);
            cover = x > first.x ? gn_back_quad(cover, at, a, b, c, d, map, params) : cover;
            a = d;
            b = c;
        }
    }
    return cover;
}
#endif

#endif
