// SPDX-License-Identifier: MIT
// Where on the map something can hide the light from the receiver: what the pyramid between receiver and light covers, from the
// nearest depth on that a multiscale map holds there; and whether all of it or nothing does.
// Based on: Guennebaud, Barthe, Paulin. Real-time Soft Shadow Mapping by Backprojection. EGSR 2006. [GBP06]
// The finer pyramids: Schwarz, Stamminger. Bitmask Soft Shadows. Computer Graphics Forum 2007. [SS07]
#ifndef GN_SHADOW_BACKPROJECTION_SEARCH_GLSL
#define GN_SHADOW_BACKPROJECTION_SEARCH_GLSL

#include "shadow/lookup/backprojection/backprojection.h"
#include "shadow/lookup/backprojection/light_plane.glsl"
#include "shadow/lookup/backprojection/texels.glsl"
#include "shadow/receiver/map_range.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The corner of the receiver's pyramid where it meets the plane at `nearest`, or of the light itself where that lies before it; a
// square around a disc.
GN_FN vec3 gn_back_corner_ws(GnLightView view, GnBackLight light, float nearest, int corner) {
    vec3 way_ws = light.centre_ws + ((corner & 1) == 0 ? -1.0f : 1.0f) * light.right_ws +
                  ((corner & 2) == 0 ? -1.0f : 1.0f) * light.up_ws;
    float before = max(dot(view.depth_from_ws, vec4(light.p_ws, 1.0f)) - nearest, 0.0f);
    float fall = -dot(vec3(view.depth_from_ws), way_ws);
    float most = light.far ? 1.0e6f * view.metres_per_depth : 1.0f;
    return light.p_ws + (fall * most > before ? before / fall : most) * way_ws;
}

// Least and greatest uv of the pyramid; the whole view where it reaches behind the eye.
GN_FN vec4 gn_back_area(GnLightView view, vec4 bounds_ts, GnBackLight light, float nearest) {
    vec2 rect_ts = vec2(view.rect_ts.x, view.rect_ts.y);
    vec2 half_ts = 0.5f * vec2(view.rect_ts.z, view.rect_ts.w);
    vec4 p_cs = gn_clip(view, light.p_ws);
    vec2 p_ts = rect_ts + (vec2(p_cs.x, p_cs.y) / p_cs.w + 1.0f) * half_ts;
    vec4 area = vec4(p_ts.x, p_ts.y, p_ts.x, p_ts.y);
    for (int corner = 0; corner < 4; ++corner) {
        vec4 q_cs = gn_clip(view, gn_back_corner_ws(view, light, nearest, corner));
        if (!(q_cs.w > 1.0e-5f * p_cs.w)) {
            return bounds_ts;
        }
        vec2 q_ts = rect_ts + (vec2(q_cs.x, q_cs.y) / q_cs.w + 1.0f) * half_ts;
        area = vec4(min(area.x, q_ts.x), min(area.y, q_ts.y), max(area.z, q_ts.x), max(area.w, q_ts.y));
    }
    return area;
}

// The texels that the corners of all cells within an area are read from: centres, or `corners` between four. A 64th of a texel
// covers rounding.
GN_FN ivec4 gn_back_texels(vec4 area_ts, float texel_ts, bool corners) {
    vec4 at = clamp(area_ts / texel_ts, vec4(-1.0e6f), vec4(1.0e6f));
    float before = corners ? 1.0f : 0.5f;
    vec4 first = floor(at - before - 0.015625f);
    vec4 last = floor(at + before + 0.015625f);
    return ivec4(int(first.x), int(first.y), int(last.z), int(last.w));
}

// The texels of a view's rectangle.
GN_FN ivec4 gn_back_view_texels(vec4 bounds_ts, float texel_ts) {
    vec4 at = floor(bounds_ts / texel_ts + 0.5f);
    return ivec4(int(at.x), int(at.y), int(at.z) - 1, int(at.w) - 1);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Beyond a view other views go on where kernels cross them; else what stands at its border goes on.
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view
#ifdef GN_CROSSING
const bool gn_back_views_end = true;
#else
const bool gn_back_views_end = false;
#endif

// Of an area's texels those that are read: within the view where it ends, else not farther from it than it is wide.
ivec4 gn_back_reached(ivec4 texels, ivec4 view) {
    ivec2 beyond = gn_back_views_end ? ivec2(0) : view.zw - view.xy + 1;
    return ivec4(max(texels.xy, view.xy - beyond), min(texels.zw, view.zw + beyond));
}

struct GnBackSearch {
    ivec4 texels;      // first.xy, last.zw, both included
    ivec4 held;        // the same within the view
    bool whole;        // nothing of the area lies beyond the view
    float nearest;     // the depth before which nothing of the area lies
    float enlarged;    // so many times as large the light is taken
    float visibility;  // 0 or 1 where least and greatest depth decide, else -1
};

GnBackSearch gn_back_unsearched() {
    GnBackSearch search;
    search.visibility = -1.0;
    search.enlarged = 1.0;
    search.nearest = 0.0;
    return search;
}

// What the receiver's view holds of an area.
GnBackSearch gn_back_within(GnBackSearch search, GnLookup at, vec4 area_ts, GnBackprojectionParams params) {
    ivec4 view = gn_back_view_texels(at.projected.bounds_ts, at.projected.texel_ts);
    ivec4 texels = gn_back_texels(area_ts, at.projected.texel_ts, GN_BACK_CORNERS != 0);
    search.held = ivec4(clamp(texels.xy, view.xy, view.zw - 1), clamp(texels.zw, view.xy + 1, view.zw));
    search.whole = search.held == texels;
    search.texels = gn_back_reached(texels, view);
    return search;
}

// Whether the range of depths that a rectangle of texels holds hides none of the light or all of it: 1, 0, else -1. Steps that are too
// deep to be closed are gaps through which the light may be seen.
float gn_back_class(GnLookup at, GnBackRays rays, GnBackSearch search, vec2 range, GnBackprojectionParams params) {
    ivec4 texels = search.held;
    // The plane is flat between its corners; a cone lies below it, deepest at the corners.
    float nearest = 1.0e30;
    float farthest = -1.0e30;
    bool between = true;
    for (int k = 0; k < 4; ++k) {
        vec2 texel = vec2((k & 1) == 0 ? texels.x : texels.z, (k & 2) == 0 ? texels.y : texels.w);
        vec2 uv_ts = (texel + 0.5) * at.projected.texel_ts;
        float plane = gn_depth_at(at.projected, uv_ts, at.bias);
        nearest = min(nearest, plane);
        farthest = max(farthest, plane + gn_cone(at.projected, uv_ts - at.projected.uv_ts));
        between = between && gn_back_between(rays, gn_back_point(rays, uv_ts, range.x)) &&
                  gn_back_between(rays, gn_back_point(rays, uv_ts, range.y));
    }
    bool closed = params.gap_limit == 0.0 || (range.y - range.x) * at.projected.metres_per_depth <= params.gap_limit;
    bool dark = closed && (search.whole || !gn_back_views_end) && between && nearest > range.y;
    return farthest <= range.x ? 1.0 : dark ? 0.0 : -1.0;
}

// Least and greatest depth of at least a rectangle of texels.
vec2 gn_back_range(GN_BACK_MAPS, ivec4 texels, int layer, GnBackprojectionParams params) {
    if (GN_BACK_PYRAMID == GN_BACK_MSSM) {
        return gn_n_buffer_min_max(squares, texels.xy, texels.zw, layer, gn_back_levels(squares));
    }
    int levels = textureQueryLevels(pyramid);
    if (GN_BACK_PYRAMID == GN_BACK_YSM && gn_pyramid_level(texels.xy, texels.zw, levels) > gn_coarse_mip) {
        ivec2 edge = textureSize(squares, 0).xy - 1;
        return gn_n_buffer_min_max(squares, min(texels.xy >> gn_coarse_mip, edge), min(texels.zw >> gn_coarse_mip, edge),
                                   layer, gn_back_levels(squares));
    }
    return gn_pyramid_min_max(pyramid, texels.xy, texels.zw, layer, levels);
}

GnBackSearch gn_back_search(GnLookup at, GN_BACK_MAPS, GnBackLight light, GnBackRays rays, GnBackprojectionParams params) {
    GnBackSearch result = gn_back_unsearched();
    for (int step = 0; step <= params.refine; ++step) {
        // A light that covers less than the least number of texels is taken for a larger one.
        vec4 area_ts = gn_back_area(at.view, at.projected.bounds_ts, light, result.nearest);
        if (params.least > 0.0) {
            vec2 reach = 0.5 * (area_ts.zw - area_ts.xy) / at.projected.texel_ts;
            result.enlarged = max(1.0, params.least / max(max(reach.x, reach.y), 1.0e-6));
            GnBackLight enlarged = gn_back_scaled(light, result.enlarged);
            area_ts = gn_back_area(at.view, at.projected.bounds_ts, enlarged, result.nearest);
        }
        result = gn_back_within(result, at, area_ts, params);
        if (GN_BACK_PYRAMID == GN_BACK_NONE) {
            break;
        }
        vec2 range = gn_back_range(GN_BACK_THESE, result.held, at.projected.layer, params);
        result.visibility = params.early_out != 0 ? gn_back_class(at, rays, result, range, params) : -1.0;
        if (result.visibility >= 0.0) {
            break;
        }
        result.nearest = max(range.x, result.nearest);
    }
    return result;
}

// How much coarser than the map the level is at which no more texels than the budget are read, and at least.
float gn_back_coarseness(GnBackSearch search, GnBackprojectionParams params) {
    if (params.budget == 0 || GN_BACK_PYRAMID == GN_BACK_NONE || GN_BACK_LAYERS > 1) {
        return 0.0;
    }
    ivec2 size = search.texels.zw - search.texels.xy + 1;
    return clamp(0.5 * log2(max(float(size.x * size.y) / float(params.budget), 1.0)), 0.0, 8.0);
}

// Texels of a level whose centres are corners of all cells over the map's.
ivec4 gn_back_at_level(ivec4 texels, ivec4 view, int level) {
    if (level == 0) {
        return texels;
    }
    float side = float(1 << level);
    ivec2 first = ivec2(floor((vec2(texels.xy) + 0.5) / side - 0.5));
    ivec2 last = ivec2(ceil((vec2(texels.zw) + 0.5) / side - 0.5));
    return gn_back_reached(ivec4(first, last), view >> level);
}
#endif

#endif
