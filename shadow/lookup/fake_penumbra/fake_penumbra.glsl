// SPDX-License-Identifier: MIT
// Penumbrae drawn around the edges of hard shadows: found by a search around the receiver, or from a map of how far the blocked
// region goes on.
// Based on: Brabec, Seidel. Single Sample Soft Shadows using Depth Maps. Graphics Interface 2002. [BS02]
// Based on: Kirsch, Doellner. Real-Time Soft Shadows Using a Single Light Sample. WSCG 2003. [KD03]
// Departs from them: widths are those of the light, in its own shape; the ramp is that of a half-plane.
#ifndef GN_SHADOW_LOOKUP_FAKE_PENUMBRA_GLSL
#define GN_SHADOW_LOOKUP_FAKE_PENUMBRA_GLSL

#include "shadow/lookup/fake_penumbra/fake_edge.glsl"
#include "shadow/lookup/sssm/sssm.glsl"

#ifndef __cplusplus

// One of these is run:
//   #define GN_FAKE_SEARCH
//   #define GN_FAKE_WIDTHS
//   #define GN_FAKE_SHADOWS

// The texel of a place on the map, and what it holds.
ivec2 gn_fake_texel(GnLookup at) { return ivec2(floor(at.projected.uv_ts / at.projected.texel_ts)); }
GnPcssTap gn_fake_tap(GnLookup at, sampler2DArray depth, GnExtentMetres metres, ivec2 texel) {
    return gn_pcss_tap(at, depth, metres, (vec2(texel) + 0.5) * at.projected.texel_ts);
}

#if defined(GN_FAKE_SEARCH)
// Texels along a side of a block.
const int gn_fake_block = 8;

// What a search around the receiver found: the nearest texel of the other kind, lit where the receiver's is not, or not where it is.
struct GnFakeFound {
    float reach;    // norm of the light's point that sees it, times the spread; 1e30 for none
    ivec2 texel;
};

// The way from a place to the nearest point of a block, in texels.
vec2 gn_fake_to_block(vec2 place, ivec2 first) {
    float half_side = 0.5 * float(gn_fake_block);
    vec2 d = vec2(first) + half_side - place;
    return sign(d) * max(abs(d) - half_side, vec2(0.0));
}

GnFakeFound gn_fake_nearer(GnFakeFound found, GnLookup at, GnFakeAxes axes, ivec2 texel, bool other, int radius) {
    vec2 way = gn_fake_to_texel(at.projected.uv_ts / at.projected.texel_ts, texel);
    float reach = gn_fake_norm(axes.square, gn_fake_point(axes, way * at.projected.texel_ts));
    bool nearer = other && reach < found.reach && dot(way, way) <= float(radius * radius);
    found.texel = nearer ? texel : found.texel;
    found.reach = nearer ? reach : found.reach;
    return found;
}

// Of a block within the view, four texels at a time.
GnFakeFound gn_fake_in_block(GnFakeFound found, GnLookup at, sampler2DArray depth, GnFakeAxes axes, bool lit, ivec2 first, int gathers,
                             int radius) {
    for (int i = 0; i < gathers; ++i) {
        ivec2 texel = first + 2 * ivec2(i % (gn_fake_block / 2), i / (gn_fake_block / 2));
        vec2 corner_ts = vec2(texel + 1) * at.projected.texel_ts;
        vec2 low_ts = corner_ts - 0.5 * at.projected.texel_ts;
        vec2 high_ts = corner_ts + 0.5 * at.projected.texel_ts;
        vec4 four = gn_map_gather(depth, at, corner_ts);
        bvec4 lit_four = gn_lit_at(at.projected, vec4(low_ts.x, high_ts.x, high_ts.x, low_ts.x),
                                   vec4(high_ts.y, high_ts.y, low_ts.y, low_ts.y), four, at.bias);
        found = gn_fake_nearer(found, at, axes, texel + ivec2(0, 1), lit_four.x != lit, radius);
        found = gn_fake_nearer(found, at, axes, texel + ivec2(1, 1), lit_four.y != lit, radius);
        found = gn_fake_nearer(found, at, axes, texel + ivec2(1, 0), lit_four.z != lit, radius);
        found = gn_fake_nearer(found, at, axes, texel, lit_four.w != lit, radius);
    }
    return found;
}

// Of one that leaves the view, one by one, where kernels go on in the views beside it.
GnFakeFound gn_fake_in_others(GnFakeFound found, GnLookup at, sampler2DArray depth, GnExtentMetres metres, GnFakeAxes axes, bool lit, ivec2 first,
                              int texels, int radius) {
    for (int i = 0; i < texels; ++i) {
        ivec2 texel = first + ivec2(i % gn_fake_block, i / gn_fake_block);
        found = gn_fake_nearer(found, at, axes, texel, gn_fake_tap(at, depth, metres, texel).lit != lit, radius);
    }
    return found;
}

// Rings of blocks, until no farther one can hold a nearer texel. A loop, unlike a choice, ends for all neighbours where none goes
// on.
GnFakeFound gn_fake_search(GnLookup at, sampler2DArray depth, GnExtentMetres metres, GnFakeAxes axes, bool lit, int radius) {
    GnFakeFound found = GnFakeFound(1.0e30, ivec2(0));
    vec2 place = at.projected.uv_ts / at.projected.texel_ts;
    ivec2 middle = gn_fake_texel(at) / gn_fake_block;
    for (int ring = 0; ring <= (radius + gn_fake_block - 1) / gn_fake_block; ++ring) {
        if (float(gn_fake_block * (ring - 1)) * at.projected.texel_ts * axes.least >= found.reach) {
            break;
        }
        for (int i = 0; i < max(8 * ring, 1); ++i) {
            int side = i / max(2 * ring, 1);
            int along = i - side * 2 * ring - ring;
            ivec2 beside = side == 0   ? ivec2(along, -ring)
                           : side == 1 ? ivec2(ring, along)
                           : side == 2 ? ivec2(-along, ring)
                                       : ivec2(-ring, -along);
            ivec2 first = (middle + beside) * gn_fake_block;
            vec2 way = abs(gn_fake_to_block(place, first));
            bool nearer = max(way.x, way.y) * at.projected.texel_ts * axes.least < found.reach && dot(way, way) <= float(radius * radius);
            vec2 first_ts = vec2(first) * at.projected.texel_ts;
            bool within = gn_within_view(at.projected, first_ts, first_ts + float(gn_fake_block) * at.projected.texel_ts);
            const int texels = gn_fake_block * gn_fake_block;
            found = gn_fake_in_block(found, at, depth, axes, lit, first, nearer && within ? texels / 4 : 0, radius);
            found = gn_fake_in_others(found, at, depth, metres, axes, lit, first, nearer && !within ? texels : 0, radius);
        }
    }
    return found;
}

float gn_fake_penumbra_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, sampler2DArray steps,
                                  GnFakePenumbraParams params) {
    GnExtentLight half_light = gn_fake_light(at.light, at.receiver.p_ws);
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnPcssTap own = gn_fake_tap(at, depth, metres, gn_fake_texel(at));
    if (!gn_fake_spreads(at.light, params)) {
        return own.lit ? 1.0 : 0.0;
    }
    GnExtentRegion region = gn_extent_region(at, pyramid, half_light, metres, params.least, true);
    if (region.visibility >= 0.0) {
        return region.visibility;
    }
    vec2 widest_ts = gn_extent_reach(gn_extent_kernel(at, half_light, region.spread), half_light.square);
    float most = max(max(widest_ts.x, widest_ts.y) / at.projected.texel_ts, params.least);
    int radius = int(ceil(min(most, float(params.radius)))) + 1;
    GnFakeAxes axes = gn_fake_axes(at, half_light);
    GnFakeFound found = gn_fake_search(at, depth, metres, axes, own.lit, radius);
    if (found.reach >= 1.0e30) {
        return own.lit ? 1.0 : 0.0;
    }
    // What casts the edge stands where the receiver is dark, or where the texel is that was found.
    float blocker = own.lit ? gn_fake_tap(at, depth, metres, found.texel).distance : own.distance;
    float spread = gn_extent_spread_at(at, region.receiver, blocker);
    float away = length(gn_fake_to_texel(at.projected.uv_ts / at.projected.texel_ts, found.texel));
    float x = gn_fake_distance(away, found.reach, spread, params.least, float(params.radius));
    return gn_fake_ramp(half_light.square, own.lit ? x : -x);
}
#elif defined(GN_FAKE_WIDTHS)
// [KD03]: only what is dark becomes lighter. `steps`: the way, in texels, to the nearest that lies behind a step of depth.
float gn_fake_penumbra_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, sampler2DArray steps,
                                  GnFakePenumbraParams params) {
    GnExtentLight half_light = gn_fake_light(at.light, at.receiver.p_ws);
    GnExtentMetres metres = gn_extent_metres_of(at);
    ivec2 texel = gn_fake_texel(at);
    GnPcssTap own = gn_fake_tap(at, depth, metres, texel);
    if (own.lit || !gn_fake_spreads(at.light, params)) {
        return own.lit ? 1.0 : 0.0;
    }
    vec2 away = gn_map_texel(steps, at, texel).xy;
    ivec2 end = texel + ivec2(away);
    vec2 end_ts = (vec2(end) + 0.5) * at.projected.texel_ts;
    // What lies behind that step may hide the light too: then nobody knows where it ends.
    if (max(abs(away.x), abs(away.y)) > float(params.radius) + 1.0 || !gn_within_view(at.projected, end_ts, end_ts) ||
        !gn_fake_tap(at, depth, metres, end).lit) {
        return 0.0;
    }
    float receiver = gn_extent_distance(metres, at.view, at.projected.uv_ts, at.projected.depth);
    vec2 way = gn_fake_to_texel(at.projected.uv_ts / at.projected.texel_ts, end);
    GnFakeAxes axes = gn_fake_axes(at, half_light);
    float reach = gn_fake_norm(axes.square, gn_fake_point(axes, way * at.projected.texel_ts));
    float spread = gn_extent_spread_at(at, receiver, own.distance);
    // The whole width lies inside.
    return gn_fake_ramp(axes.square, 1.0 - 2.0 * gn_fake_distance(length(way), reach, 2.0 * spread, params.least, float(params.radius)));
}
#elif defined(GN_FAKE_SHADOWS)
// 1 in shadow, and what hides the light there lies so many metres before the receiver, packed.
vec3 gn_fake_penumbra_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, sampler2DArray steps,
                                 GnFakePenumbraParams params) {
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnPcssTap own = gn_fake_tap(at, depth, metres, gn_fake_texel(at));
    float receiver = gn_extent_distance(metres, at.view, at.projected.uv_ts, at.projected.depth);
    return own.lit ? vec3(0.0) : vec3(1.0, gn_sssm_pack(max(receiver - own.distance, 0.0)), 0.0);
}
#endif
#endif

#endif
