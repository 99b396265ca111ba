// SPDX-License-Identifier: MIT
// Separable soft shadows: search and filter read one row of the kernel each in the map, and the other rows in the picture, where
// neighbours have read them.
// Based on: Buades, Gumbau, Chover. Separable Soft Shadow Mapping. The Visual Computer 2016. [BGC16]
// Departs from it: rows are read in the map and not in the picture, and are those of the light's own axes; where neighbours are
// of no use their rows are left out.
#ifndef GN_SHADOW_LOOKUP_SSSM_GLSL
#define GN_SHADOW_LOOKUP_SSSM_GLSL

#include "shadow/lookup/pcss/pcss_tap.glsl"
#include "shadow/lookup/sssm/sssm.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Point i of n along an axis of the light, from -1 to 1, moved by up to half their distance.
GN_FN float gn_sssm_point(int i, int n, float noise, int jitter) {
    float within = jitter != 0 ? noise : 0.5f;
    return 2.0f * (float(i) + within) / float(n) - 1.0f;
}

// How far across its row point i of a row alone lies, as a share of what the light has across it there: by the golden ratio, so
// that the points of a row lie evenly on the square that they then are on. Only what lengthens the kernel is shared out so.
GN_FN float gn_sssm_across(int i, float noise, int jitter) {
    return 2.0f * fract(0.61803399f * float(i) + (jitter != 0 ? fract(7.0f * noise + 0.5f) : 0.5f)) - 1.0f;
}

// What a point of an axis weighs: as much of the light as lies across it.
GN_FN float gn_sssm_weight(bool square, float x) { return square ? 1.0f : sqrt(max(1.0f - x * x, 0.0f)); }

// Where the receiver's plane is seen on the ray from the light to a point that lies `way_ws` beside the receiver: the place of the
// neighbour whose row goes through that point of the kernel. w = 0 where the ray does not meet the plane.
GN_FN vec4 gn_sssm_neighbour(GnLight light, vec3 p_ws, vec3 n_ws, vec3 way_ws) {
    bool far = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    vec3 beside_ws = p_ws + way_ws;
    vec3 ray_ws = far ? vec3(light.direction_ws) : beside_ws - vec3(light.position_ws);
    float falls = dot(n_ws, ray_ws);
    if (abs(falls) < 1.0e-3f * length(ray_ws)) {
        return vec4(p_ws, 0.0f);
    }
    float along = -dot(n_ws, way_ws) / falls;
    return vec4(beside_ws + along * ray_ws, far || along > -0.99f ? 1.0f : 0.0f);
}

// The spread of what lies `before` metres before the receiver, along the light's axis.
GN_FN float gn_sssm_spread(GnLight light, vec3 p_ws, float before) {
    if (light.kind == uint(GN_LIGHT_DIRECTIONAL)) {
        return before;
    }
    float receiver = dot(gn_extent_axis(light, p_ws), p_ws - vec3(light.position_ws));
    float blocker = max(receiver - before, 0.0f);
    float spread = gn_extent_spread(false, receiver, blocker);
    return light.kind == uint(GN_LIGHT_POINT) ? spread * gn_extent_bulge(light.radius, blocker) : spread;
}

// Metres and spreads in [0,1], as rows hand them on; 1 where all of the light is hidden. A power of two keeps every bit, whatever
// the unit of length.
GN_FN float gn_sssm_pack(float value) { return min(value * 5.42101086e-20f, 0.5f); }
GN_FN float gn_sssm_unpack(float packed) { return packed * 1.84467441e19f; }

// The spread that the picture has where all of the light is hidden: longer than any that is packed, in whatever unit.
GN_FN float gn_sssm_all() { return 1.0e30f; }

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// One of three passes: rows of the search, rows of the filter, or both at once over the whole grid.
//   #define GN_SSSM_SEARCH
//   #define GN_SSSM_FILTER
//   #define GN_SSSM_GRID

// Weights of what was read and of what of it hides the light, and the latter times how many metres it lies before the receiver.
struct GnSssmSum {
    float weight;
    float hidden;
    float before;
};

void gn_sssm_add(GnLookup at, sampler2DArray depth, GnExtentMetres metres, float receiver, vec2 tap_ts, float weight, inout GnSssmSum sum) {
    GnPcssTap tap = gn_pcss_tap(at, depth, metres, tap_ts);
    sum.weight += weight;
    if (!tap.lit) {
        sum.hidden += weight;
        sum.before += weight * max(receiver - tap.distance, 0.0);
    }
}

// The row y of the kernel that the light's points make through a plane at `spread`. A row that stands for the grid is as broad as
// `least` makes the kernel beyond the light's points, which the rows of neighbours have.
void gn_sssm_row(GnLookup at, sampler2DArray depth, GnExtentLight half_light, GnExtentMetres metres, float receiver, float spread, float y,
                 bool alone, GnSssmParams params, inout GnSssmSum sum) {
    GnExtentKernel kernel = gn_extent_kernel(at, half_light, spread);
    GnExtentWiden widen = gn_extent_widen(kernel, 0.0, params.least * at.projected.texel_ts);
    float noise = gn_gradient_noise(at.receiver.p_ss);
    float weight = gn_sssm_weight(half_light.square, y);
    for (int i = 0; i < params.side; ++i) {
        float x = gn_sssm_point(i, params.side, noise, params.jitter);
        vec2 tap_ts = gn_extent_tap_ts(at, kernel, widen, vec2(x, y));
        if (alone) {
            tap_ts += gn_sssm_across(i, noise, params.jitter) * gn_sssm_weight(half_light.square, x) * widen.up_ts;
        }
        gn_sssm_add(at, depth, metres, receiver, tap_ts, weight * gn_sssm_weight(half_light.square, x), sum);
    }
}

// All rows of a kernel.
GnSssmSum gn_sssm_grid(GnLookup at, sampler2DArray depth, GnExtentLight half_light, GnExtentMetres metres, float receiver, float spread,
                       GnSssmParams params) {
    GnSssmSum sum = GnSssmSum(0.0, 0.0, 0.0);
    for (int j = 0; j < params.side; ++j) {
        gn_sssm_row(at, depth, half_light, metres, receiver, spread, gn_sssm_point(j, params.side, 0.5, 0), false, params, sum);
    }
    return sum;
}

// The lowest bit of a spread tells that the rows of its kernel lie closer than pixels do, so that no neighbour has others than the
// receiver.
float gn_sssm_marked(float spread, bool close) {
    return uintBitsToFloat((floatBitsToUint(spread) & ~1u) | (close ? 1u : 0u));
}
bool gn_sssm_close(float spread) { return (floatBitsToUint(spread) & 1u) != 0u; }

#ifdef GN_SSSM_SEARCH
// The row through the receiver of the region where anything can hide the light: how much of it does, how many metres before the
// receiver, and the region's spread, the last two packed.
vec3 gn_sssm_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnSssmParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnExtentRegion region = gn_extent_region(at, pyramid, half_light, metres, params.least, params.early_out != 0);
    if (region.visibility >= 0.0) {
        float before = gn_sssm_pack(max(region.receiver - region.nearest, 0.0));
        return region.visibility > 0.0 ? vec3(0.0) : vec3(1.0, before, 1.0);
    }
    GnSssmSum sum = GnSssmSum(0.0, 0.0, 0.0);
    gn_sssm_row(at, depth, half_light, metres, region.receiver, region.spread, 0.0, true, params, sum);
    // What hides the light may lie on the receiver, where its spread is none: 0 says that nothing does.
    float spread = max(region.spread, 1.0e-15);
    return vec3(sum.hidden / sum.weight, gn_sssm_pack(sum.before / max(sum.hidden, 1.0e-6)), gn_sssm_pack(spread));
}
#elif defined(GN_SSSM_FILTER)
// The row through the receiver of a kernel as wide as the penumbra, or all of it where rows lie closer than pixels. `spreads`: the
// picture's, below 0 where nothing hides the light, gn_sssm_all() where all of it is hidden.
float gn_sssm_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, sampler2DArray spreads, GnSssmParams params) {
    float spread = texelFetch(spreads, ivec3(ivec2(at.receiver.p_ss), 0), 0).r;
    if (spread < 0.0 || spread >= gn_sssm_all()) {
        return spread < 0.0 ? 1.0 : 0.0;
    }
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnSssmSum sum = GnSssmSum(0.0, 0.0, 0.0);
    if (gn_sssm_close(spread)) {
        sum = gn_sssm_grid(at, depth, half_light, metres, 1.0, spread, params);
    } else {
        gn_sssm_row(at, depth, half_light, metres, 1.0, spread, 0.0, true, params, sum);
    }
    return 1.0 - sum.hidden / sum.weight;
}
#elif defined(GN_SSSM_GRID)
struct GnSssmFound {
    float visibility;  // 0 or 1 where the extremes decide or nothing was found, else -1
    float before;      // metres along the axis from what hides the light to the receiver, on average
};

GnSssmFound gn_sssm_search(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnExtentLight half_light, GnSssmParams params) {
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnExtentRegion region = gn_extent_region(at, pyramid, half_light, metres, params.least, params.early_out != 0);
    if (region.visibility >= 0.0) {
        return GnSssmFound(region.visibility, 0.0);
    }
    GnSssmSum sum = gn_sssm_grid(at, depth, half_light, metres, region.receiver, region.spread, params);
    return sum.hidden > 0.0 ? GnSssmFound(-1.0, sum.before / sum.hidden) : GnSssmFound(1.0, 0.0);
}

float gn_sssm_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnSssmParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnSssmFound found = gn_sssm_search(at, depth, pyramid, half_light, params);
    if (found.visibility >= 0.0) {
        return found.visibility;
    }
    float spread = gn_sssm_spread(at.light, at.receiver.p_ws, found.before);
    GnSssmSum sum = gn_sssm_grid(at, depth, half_light, gn_extent_metres_of(at), 1.0, spread, params);
    return 1.0 - sum.hidden / sum.weight;
}

// Metres along the axis from the receiver to what hides the light from it; 0 where nothing does.
float gn_sssm_blocker_distance(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnSssmParams params) {
    params.early_out = 0;
    return gn_sssm_search(at, depth, pyramid, gn_extent_light(at.light, at.receiver.p_ws), params).before;
}

// Metres across the penumbra, where it lies across the axis; 0 where nothing hides the light.
float gn_sssm_penumbra_width(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnSssmParams params) {
    params.early_out = 0;
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnSssmFound found = gn_sssm_search(at, depth, pyramid, half_light, params);
    return found.visibility >= 0.0 ? 0.0 : gn_extent_width(half_light, gn_sssm_spread(at.light, at.receiver.p_ws, found.before));
}
#endif
#endif

#endif
