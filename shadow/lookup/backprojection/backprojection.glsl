// SPDX-License-Identifier: MIT
// Backprojection: what a map's texels stand for in the world is projected from the receiver onto the light, and V is the part of
// the light that is left.
// Based on: Guennebaud, Barthe, Paulin. Real-time Soft Shadow Mapping by Backprojection. EGSR 2006. [GBP06]
// Occlusion bitmasks: Schwarz, Stamminger. Bitmask Soft Shadows. Computer Graphics Forum 2007. [SS07]
#ifndef GN_SHADOW_LOOKUP_BACKPROJECTION_GLSL
#define GN_SHADOW_LOOKUP_BACKPROJECTION_GLSL

#include "shadow/lookup/backprojection/contours.glsl"
#include "shadow/lookup/backprojection/emission.glsl"
#include "shadow/lookup/backprojection/patches.glsl"
#include "shadow/lookup/backprojection/quads.glsl"
#include "shadow/lookup/backprojection/search.glsl"
#include "shadow/lookup/backprojection/sparse.glsl"
#include "shadow/receiver/fusion.glsl"

#ifndef __cplusplus

// Where kernels cross views (shadow/receiver/map_access.glsl), what lies beyond the receiver's view is looked up in its own.
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view

// One comparison with the texel that the receiver falls into.
float gn_back_hard(GnLookup at, sampler2DArray depth) {
    ivec2 texel = ivec2(floor(at.projected.uv_ts / at.projected.texel_ts));
    vec2 centre_ts = (vec2(texel) + 0.5) * at.projected.texel_ts;
    return gn_depth_at(at.projected, centre_ts, at.bias) <= gn_map_texel(depth, at, texel).r ? 1.0 : 0.0;
}

// Of a light that shows a picture:
//   #define GN_BACK_EMISSION

// How the light is read: the level, and which of the peeled surfaces.
struct GnBackTurn {
    int level;
    int peeled;
};

// What one view holds of what hides the light, added to `cover`.
GnBackCover gn_back_in_view(GnBackCover cover, GnLookup at, GN_BACK_MAPS, GnBackLight light, GnBackSearch search,
                            GnBackTurn turn, GnBackprojectionParams params) {
    if (search.visibility >= 0.0) {
        return search.visibility > 0.0 ? cover : gn_back_everything();
    }
    ivec4 view = gn_back_view_texels(at.projected.bounds_ts, at.projected.texel_ts);
    GnBackMap map;
    map.rays = gn_back_rays(at.view, gn_back_scaled(light, search.enlarged));
    map.texels = gn_back_at_level(search.texels, view, turn.level);
    map.view = view >> turn.level;
    map.level = turn.level;
    map.peeled = turn.peeled;
    map.disc = light.disc;
    if (GN_BACK_OCCLUDER == GN_BACK_CONTOUR) {
        return gn_back_contours(cover, at, GN_BACK_THESE, map, params);
    }
    if (GN_BACK_OCCLUDER == GN_BACK_MICROPATCH || GN_BACK_OCCLUDER == GN_BACK_MICRORECT) {
        return gn_back_patches(cover, at, GN_BACK_THESE, map, params);
    }
    return gn_back_quads(cover, at, GN_BACK_THESE, map, params);
}

#ifdef GN_CROSSING
// The same of the views that serve the corners of the pyramid between receiver and light.
GnBackCover gn_back_in_others(GnBackCover cover, GnLookup at, GN_BACK_MAPS, GnBackLight light, GnBackSearch own,
                              GnBackTurn turn, GnBackprojectionParams params) {
    GnBackLight enlarged = gn_back_scaled(light, own.enlarged);
    ivec4 seen = ivec4(-1);
    int first = GN_CHOICE(at.receiver).first;
    for (int corner = 0; corner < 4; ++corner) {
        GnReceiver beside = at.receiver;
        beside.p_ws = gn_back_corner_ws(at.view, enlarged, own.nearest, corner);
        int index = GN_CHOICE(beside).first;
        if (index == first || any(equal(seen, ivec4(index)))) {
            continue;
        }
        seen[corner] = index;
        GnLightView view = GN_LIGHT_VIEW(index);
        if (gn_clip(view, at.receiver.p_ws).w > 0.0) {
            GnLookup there = GnLookup(at.receiver, gn_project(at.receiver, view, at.bias), at.bias, at.light, view);
            GnBackSearch search = gn_back_search(there, GN_BACK_THESE, light, gn_back_rays(view, light), params);
            cover = gn_back_in_view(cover, there, GN_BACK_THESE, light, search, turn, params);
        }
    }
    return cover;
}
#endif

// What is hidden of the light, of what is read in one turn and all others that are united with it.
GnBackCover gn_back_turn(GnBackCover cover, GnLookup at, GN_BACK_MAPS, GnBackLight light, GnBackSearch search, GnBackTurn turn,
                         GnBackprojectionParams params) {
    cover = gn_back_in_view(cover, at, GN_BACK_THESE, light, search, turn, params);
#ifdef GN_CROSSING
    if (!search.whole) {
        cover = gn_back_in_others(cover, at, GN_BACK_THESE, light, search, turn, params);
    }
#endif
    return cover;
}

#ifdef GN_BACK_EMISSION
// Of what the light sends in each colour the share that is hidden, by all peeled surfaces together.
#define GN_BACK_SHARE vec3
vec3 gn_back_hidden_at(GnLookup at, GN_BACK_MAPS, GnBackLight light, GnBackSearch search, int level,
                       GnBackprojectionParams params) {
    int turns = GN_BACK_FUSION == GN_BACK_FARTHEST ? 1 : GN_BACK_LAYERS;
    GnBackCover cover = gn_back_nothing();
    for (int i = 0; i < turns; ++i) {
        cover = gn_back_turn(cover, at, GN_BACK_THESE, light, search, GnBackTurn(level, i), params);
    }
    return gn_back_unsent(cover.mask, sent);
}
#else
// The share of the light that is hidden, by all peeled surfaces, fused.
#define GN_BACK_SHARE float
float gn_back_hidden_at(GnLookup at, GN_BACK_MAPS, GnBackLight light, GnBackSearch search, int level,
                        GnBackprojectionParams params) {
    int turns = GN_BACK_FUSION == GN_BACK_FARTHEST ? 1 : GN_BACK_LAYERS;
    GnBackCover cover = gn_back_nothing();
    GnFused fused = gn_unfused();
    for (int i = 0; i < turns; ++i) {
        cover = gn_back_turn(cover, at, GN_BACK_THESE, light, search, GnBackTurn(level, i), params);
        fused = gn_fuse(fused, gn_back_hidden(cover, GN_BACK_COMBINE == GN_BACK_BITMASK, light.disc));
        if (GN_BACK_FUSION != GN_BACK_UNION) {
            cover = gn_back_nothing();
        }
    }
    // What a union has hidden after its last layer is the greatest.
    return gn_fused(fused, GN_BACK_FUSION < GN_BACK_SUM ? GN_FUSION_MAX : GN_BACK_FUSION - GN_BACK_SUM);
}
#endif

// What is seen of the light after a search: of one level, or of two that are blended.
GN_BACK_SHARE gn_back_searched(GnLookup at, GN_BACK_MAPS, GnBackLight light, GnBackSearch search, GnBackprojectionParams params) {
    float coarseness = gn_back_coarseness(search, params);
    int level = int(params.blend != 0 ? floor(coarseness) : ceil(coarseness));
    float between = coarseness - float(level);
    GN_BACK_SHARE hidden = GN_BACK_SHARE(0.0);
    for (int end = 0; end <= (between > 0.0 ? 1 : 0); ++end) {
        hidden = mix(hidden, gn_back_hidden_at(at, GN_BACK_THESE, light, search, level + end, params), end == 0 ? 1.0 : between);
    }
    return 1.0 - hidden;
}

GnBackSearch gn_back_search_of(GnLookup at, GN_BACK_MAPS, GnBackLight light, GnBackprojectionParams params) {
    return gn_back_search(at, GN_BACK_THESE, light, gn_back_rays(at.view, light), params);
}

// A pass that only asks how far apart samples may be looked up:
//   #define GN_BACK_FOOTPRINT
#ifdef GN_BACK_FOOTPRINT
// gn_back_told of it: what least and greatest depth decide, or how many halvings apart samples may lie that a penumbra as wide as
// the searched area holds `sparse_samples` of across.
float gn_backprojection_visibility(GnLookup at, GN_BACK_MAPS, GnBackprojectionParams params) {
    GnBackLight light = gn_back_light(at.light, at.receiver.p_ws);
    GnBackSearch search = gn_back_search_of(at, GN_BACK_THESE, light, params);
    vec2 texels = vec2(max(search.texels.zw - search.texels.xy - 1, ivec2(0)));
    float width_ws = min(texels.x, texels.y) * at.projected.texel_ws;
    float pixels = width_ws / max(length(at.receiver.ddx_ws), length(at.receiver.ddy_ws));
    return gn_back_told(search.visibility, gn_back_apart(pixels, params));
}
#else
GN_BACK_SHARE gn_backprojection_visibility(GnLookup at, GN_BACK_MAPS, GnBackprojectionParams params) {
    if (!gn_back_has_size(at.light) && params.least == 0.0) {
        return GN_BACK_SHARE(gn_back_hard(at, depth));
    }
    GnBackLight light = gn_back_light(at.light, at.receiver.p_ws);
    return gn_back_searched(at, GN_BACK_THESE, light, gn_back_search_of(at, GN_BACK_THESE, light, params), params);
}
#endif

// Texels that are read of the receiver's own view; 0 where least and greatest depth decide.
float gn_backprojection_visited_texels(GnLookup at, GN_BACK_MAPS, GnBackprojectionParams params) {
    GnBackLight light = gn_back_light(at.light, at.receiver.p_ws);
    GnBackSearch search = gn_back_search_of(at, GN_BACK_THESE, light, params);
    ivec4 view = gn_back_view_texels(at.projected.bounds_ts, at.projected.texel_ts);
    float coarseness = gn_back_coarseness(search, params);
    int level = int(params.blend != 0 ? floor(coarseness) : ceil(coarseness));
    ivec4 texels = gn_back_at_level(search.texels, view, level);
    ivec2 size = max(texels.zw - texels.xy + 1, ivec2(0));
    return search.visibility >= 0.0 ? 0.0 : float(size.x * size.y);
}

// Why a search ended: 1 all of the light is seen, 2 none of it, 3 the texels had to be read.
float gn_backprojection_search_class(GnLookup at, GN_BACK_MAPS, GnBackprojectionParams params) {
    GnBackLight light = gn_back_light(at.light, at.receiver.p_ws);
    GnBackSearch search = gn_back_search_of(at, GN_BACK_THESE, light, params);
    return search.visibility == 1.0 ? 1.0 : search.visibility == 0.0 ? 2.0 : 3.0;
}

// How many levels coarser than the map what is read is.
float gn_backprojection_level(GnLookup at, GN_BACK_MAPS, GnBackprojectionParams params) {
    GnBackLight light = gn_back_light(at.light, at.receiver.p_ws);
    return gn_back_coarseness(gn_back_search_of(at, GN_BACK_THESE, light, params), params);
}
#endif

#endif
