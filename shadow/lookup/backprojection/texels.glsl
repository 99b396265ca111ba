// SPDX-License-Identifier: MIT
// A texel of the map as one receiver reads it: where it is seen before the light, and whether it hides it. Coarser levels hold
// the nearest of their texels; where surfaces are peeled, one of them or the farthest before the receiver.
// Coarse levels: Schwarz, Stamminger. Quality Scalability of Soft Shadow Mapping. Graphics Interface 2008. [SS08b]
// Peeled layers: Bavoil, Callahan, Silva. Robust Soft Shadow Mapping with Backprojection and Depth Peeling. Journal of Graphics
// Tools 2008. [BCS08]
#ifndef GN_SHADOW_BACKPROJECTION_TEXELS_GLSL
#define GN_SHADOW_BACKPROJECTION_TEXELS_GLSL

#include "shadow/lookup/backprojection/backprojection.h"
#include "shadow/lookup/backprojection/light_plane.glsl"
#include "shadow/receiver/map_access.glsl"

#ifndef __cplusplus

// What a host may fix when it compiles: the parameters that decide what a receiver runs through.
//   #define GN_BACK_PYRAMID 1
//   #define GN_BACK_CORNERS 1
//   #define GN_BACK_LAYERS 1
//   #define GN_BACK_FUSION 0
#ifndef GN_BACK_PYRAMID
#define GN_BACK_PYRAMID params.pyramid
#endif
#ifndef GN_BACK_LAYERS
#define GN_BACK_LAYERS params.layers
#endif
#ifndef GN_BACK_CORNERS
#define GN_BACK_CORNERS params.corners
#endif
#ifndef GN_BACK_FUSION
#define GN_BACK_FUSION params.fusion
#endif

// The textures that the lookup reads: the map, a pyramid and squares of least and greatest depths, and peeled surfaces. What a
// recipe does not ask for is the map again, and is not read.
// Of a light that shows a picture also what each of its points sends (emission.glsl):
//   #define GN_BACK_EMISSION
#ifdef GN_BACK_EMISSION
#define GN_BACK_MAPS \
    sampler2DArray depth, sampler2DArray pyramid, sampler2DArray squares, sampler2DArray peeled, sampler2DArray sent
#define GN_BACK_THESE depth, pyramid, squares, peeled, sent
#else
#define GN_BACK_MAPS sampler2DArray depth, sampler2DArray pyramid, sampler2DArray squares, sampler2DArray peeled
#define GN_BACK_THESE depth, pyramid, squares, peeled
#endif

struct GnBackTexel {
    vec2 seen;    // where its centre is seen before the light
    float depth;
    bool hides;   // nearer to the light than the receiver's plane
};

// What of a map is read for one receiver.
struct GnBackMap {
    GnBackRays rays;
    ivec4 texels;  // first.xy, last.zw, in texels of the level
    ivec4 view;    // likewise, of the view: beyond it stands what stands at its border
    int level;
    int peeled;    // which of the peeled surfaces
    bool disc;
};

// Levels of an N-buffer of this side.
int gn_back_levels(sampler2DArray squares) { return findMSB(textureSize(squares, 0).x) + 1; }

// What the level holds, for a receiver whose plane has this depth there.
float gn_back_depth(GnLookup at, GN_BACK_MAPS, GnBackMap map, ivec2 texel, float plane, GnBackprojectionParams params) {
    if (map.level > 0) {
        if (GN_BACK_PYRAMID == GN_BACK_MSSM) {
            int index = at.projected.layer * gn_back_levels(squares) + map.level;
            return texelFetch(squares, ivec3(texel << map.level, index), 0).x;
        }
        return texelFetch(pyramid, ivec3(texel, at.projected.layer), map.level).x;
    }
    if (GN_BACK_LAYERS < 2) {
        return gn_map_texel(depth, at, texel).r;
    }
    int first = at.projected.layer * GN_BACK_LAYERS;
    if (GN_BACK_FUSION != GN_BACK_FARTHEST) {
        return texelFetch(peeled, ivec3(texel, first + map.peeled), 0).r;
    }
    float found = texelFetch(peeled, ivec3(texel, first), 0).r;
    for (int i = 1; i < GN_BACK_LAYERS; ++i) {
        float next = texelFetch(peeled, ivec3(texel, first + i), 0).r;
        found = next < plane ? next : found;
    }
    return found;
}

// Where a corner of texels lies on the map.
vec2 gn_back_corner_ts(GnLookup at, GnBackMap map, vec2 corner) {
    return corner * (float(1 << map.level) * at.projected.texel_ts);
}

// The receiver's plane at a point, less what it changes by over `spread` texels, half to each side.
float gn_back_plane(GnLookup at, vec2 uv_ts, float spread, GnBackprojectionParams params) {
    vec2 slope = abs(at.projected.plane_slope);
    return gn_depth_at(at.projected, uv_ts, at.bias) -
           params.level_bias * 0.5 * spread * at.projected.texel_ts * (slope.x + slope.y);
}

GnBackTexel gn_back_held(GnBackMap map, vec2 uv_ts, float depth, float plane) {
    GnBackTexel result;
    vec4 n = gn_back_point(map.rays, uv_ts, depth);
    result.depth = depth;
    result.hides = depth < plane && gn_back_between(map.rays, n);
    result.seen = gn_back_seen(map.rays, n);
    return result;
}

// A level's nearest depth is compared with the nearest of the receiver's plane under the texel.
GnBackTexel gn_back_texel(GnLookup at, GN_BACK_MAPS, GnBackMap map, ivec2 texel, GnBackprojectionParams params) {
    ivec2 held = clamp(texel, map.view.xy, map.view.zw);
    float plane = gn_back_plane(at, gn_back_corner_ts(at, map, vec2(held) + 0.5), float((1 << map.level) - 1), params);
    float found = gn_back_depth(at, GN_BACK_THESE, map, held, plane, params);
    return gn_back_held(map, gn_back_corner_ts(at, map, vec2(texel) + 0.5), found, plane);
}

// The corner between four texels, as near as the nearest of them: what hides the light is then half a texel wider than the
// centres of its texels say, as it is in the mean.
GnBackTexel gn_back_between_four(GnLookup at, GN_BACK_MAPS, GnBackMap map, ivec2 corner, GnBackprojectionParams params) {
    ivec2 held = clamp(corner, map.view.xy + 1, map.view.zw);
    vec2 held_ts = gn_back_corner_ts(at, map, vec2(held));
    float plane = gn_back_plane(at, held_ts, 1.0, params);
    vec4 four;
    if (GN_BACK_LAYERS < 2) {
        four = gn_map_gather(depth, at, held_ts);
    } else {
        four.x = gn_back_depth(at, GN_BACK_THESE, map, held - ivec2(1, 1), plane, params);
        four.y = gn_back_depth(at, GN_BACK_THESE, map, held - ivec2(0, 1), plane, params);
        four.z = gn_back_depth(at, GN_BACK_THESE, map, held - ivec2(1, 0), plane, params);
        four.w = gn_back_depth(at, GN_BACK_THESE, map, held, plane, params);
    }
    return gn_back_held(map, gn_back_corner_ts(at, map, vec2(corner)), min(min(four.x, four.y), min(four.z, four.w)), plane);
}

// Where a corner of texels, at a depth, is seen before the light.
vec2 gn_back_corner(GnLookup at, GnBackMap map, vec2 corner, float depth) {
    return gn_back_seen(map.rays, gn_back_point(map.rays, gn_back_corner_ts(at, map, corner), depth));
}
#endif

#endif
