// SPDX-License-Identifier: MIT
// Which tile of a quadtree over the light's map serves a receiver: the finest that holds it, and where each asks for itself none
// that is finer than it asks for.
// Compiles as GLSL and as C++.
//
// Based on: Lefohn, Sengupta, Owens. Resolution-Matched Shadow Maps. ACM Transactions on Graphics 26(4), 2007. [LSO07]
#ifndef GN_SHADOW_PLACEMENT_ADAPTIVE_GLSL
#define GN_SHADOW_PLACEMENT_ADAPTIVE_GLSL

#include "shadow/placement/adaptive/adaptive.h"
#include "shadow/placement/faces.glsl"
#include "shadow/receiver/undersampling.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Where a point lies on a map, [0,1]^2, and how that changes over the world, per metre.
struct GnAdaptivePlace {
    vec2 uv;
    vec3 du_ws;
    vec3 dv_ws;
};

// x, y and w: rows of the map's view that give clip coordinates of a world point.
GN_FN GnAdaptivePlace gn_adaptive_place(vec4 x, vec4 y, vec4 w, vec3 p_ws) {
    vec4 p = vec4(p_ws, 1.0f);
    float inverse = 1.0f / dot(w, p);
    vec2 p_ndc = vec2(dot(x, p), dot(y, p)) * inverse;
    GnAdaptivePlace place;
    place.uv = 0.5f * p_ndc + 0.5f;
    place.du_ws = (vec3(x) - p_ndc.x * vec3(w)) * (0.5f * inverse);
    place.dv_ws = (vec3(y) - p_ndc.y * vec3(w)) * (0.5f * inverse);
    return place;
}

// Nodes of the quadtree of one map that are coarser than a level: 1 + 4 + 16 + ...
GN_FN int gn_adaptive_before(int level) { return ((1 << (2 * level)) - 1) / 3; }

// A node, of all maps' nodes: map by map, level by level, row by row.
GN_FN int gn_adaptive_node(int levels, int map, int level, ivec2 cell) {
    return map * gn_adaptive_before(levels + 1) + gn_adaptive_before(level) + (cell.y << level) + cell.x;
}

// The tile of a level that a place lies in; what lies beyond the map belongs to the nearest.
GN_FN ivec2 gn_adaptive_cell(vec2 uv, int level) {
    int side = 1 << level;
    return clamp(ivec2(floor(uv * float(side))), ivec2(0), ivec2(side - 1));
}

// The coarsest level at which a map has as many texels as `asked` along its side, or the finest there is.
GN_FN int gn_adaptive_level(float asked, float texels, int levels) {
    int level = 0;
    for (float has = texels; has < asked && level < levels; has *= 2.0f) {
        ++level;
    }
    return level;
}

// The finest level at which a kernel that reaches over `reach` of the map stays within a tile's border.
GN_FN int gn_adaptive_widest(int level, float reach, float texels, float border) {
    int widest = level;
    for (float has = texels * exp2(float(level)); widest > 0 && reach * has > border; has *= 0.5f) {
        --widest;
    }
    return widest;
}

// Texels along the side of a map at which a pixel's footprint has `density` of them where it has fewest: m of [EASW09] eq. 3.2
// is 1 over it.
GN_FN float gn_adaptive_asked(GnAdaptiveData data, GnReceiver receiver, GnAdaptivePlace place) {
    return data.density * gn_undersampling(receiver, place.du_ws, place.dv_ws, 1.0f);
}

// The level that a receiver asks for.
GN_FN int gn_adaptive_wanted(GnAdaptiveData data, GnReceiver receiver, GnAdaptivePlace place) {
    int level = gn_adaptive_level(gn_adaptive_asked(data, receiver, place), data.texels, data.levels);
    float reach = data.reach_ws * max(length(place.du_ws), length(place.dv_ws));
    return gn_adaptive_widest(level, reach, data.texels, data.reach_texels);
}

// The map that a point lies on: the only one, or the face around the light.
GN_FN int gn_adaptive_map(GnAdaptiveData data, vec3 p_ws) {
    return data.eye_ws.w > 0.5f ? gn_face_of(p_ws - vec3(data.eye_ws)) : 0;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Of a node: 1 + the view that draws its tile, 0 where it has none. Of a map three rows: x, y and w of its view.
uint gn_adaptive_pages(int i);
vec4 gn_adaptive_rows(int i);

// The tile that serves a receiver: its node and level in the tree, and the view that draws it.
struct GnAdaptiveFound {
    int node;
    int level;
    int view;
};

GnAdaptiveFound gn_adaptive_find(GnReceiver receiver, GnAdaptiveData data) {
    int map = gn_adaptive_map(data, receiver.p_ws);
    GnAdaptivePlace place = gn_adaptive_place(gn_adaptive_rows(3 * map), gn_adaptive_rows(3 * map + 1),
                                              gn_adaptive_rows(3 * map + 2), receiver.p_ws);
    int finest = data.leaves != 0 ? data.levels : gn_adaptive_wanted(data, receiver, place);
    for (int level = finest; level >= 0; --level) {
        int node = gn_adaptive_node(data.levels, map, level, gn_adaptive_cell(place.uv, level));
        uint page = gn_adaptive_pages(node);
        if (page != 0u) {
            return GnAdaptiveFound(node, level, int(page) - 1);
        }
    }
    return GnAdaptiveFound(-1, -1, 0);
}

GnChoice gn_adaptive_choose(GnReceiver receiver, GnAdaptiveData data) {
    return gn_only(gn_adaptive_find(receiver, data).view);
}

#endif
#endif
