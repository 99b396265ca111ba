// SPDX-License-Identifier: MIT
// Contact-hardening shadows: search and filter read the same few texels, of the mip in which they span the kernel.
// Based on: Sikachev, Delmont, Doyon, Bucci. Next-Generation Rendering in Thief. GPU Pro 6, 2015. [SDDB15]
// The grid and the mips: Akenine-Moeller, Haines, Hoffman, Pesce, Iwanicki, Hillaire. Real-Time Rendering. 2018. [AHH18], 7.6.
// Departs from them: the kernel is the light itself, in its own shape and size, and no length is set by hand; a texel whose
// least and greatest depth lie on both sides of the receiver's plane is looked into.
#ifndef GN_SHADOW_LOOKUP_CHS_GLSL
#define GN_SHADOW_LOOKUP_CHS_GLSL

#include "shadow/lookup/chs/chs.h"
#include "shadow/receiver/light_extent.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The finest mip of which `side` texels span a kernel that is `width` texels of the map wide, wherever it begins. [AHH18] 7.6
GN_FN int gn_chs_level(float width, int side, int coarsest) {
    int level = 0;
    while (level < coarsest && width > float(side - 1) * float(1 << level)) {
        ++level;
    }
    return level;
}

// The coarsest mip whose texels are a view's own: where the view does not fill its layer, its rectangle must begin and end at
// multiples of them.
GN_FN int gn_chs_coarsest(GnProjected projected, int levels) {
    ivec4 sides = ivec4(floor(projected.bounds_ts / projected.texel_ts + 0.5f));
    int bits = sides.x | sides.y | sides.z | sides.w;
    int coarsest = 0;
    while (coarsest < levels - 1 && (bits & (1 << coarsest)) == 0) {
        ++coarsest;
    }
    return coarsest;
}

// What a texel's least and greatest depth say of it, where the receiver's plane is between `near` and `far` in it: 0 all of it
// lets light through, 1 all of it hides the light, -1 it must be looked into.
GN_FN float gn_chs_decided(vec2 range, float near, float far) {
    return range.x >= far ? 0.0f : range.y < near ? 1.0f : -1.0f;
}

// Coordinates of a step on the map in the kernel's axes: x right_ts + y up_ts = d_ts. `determinant`: of the two axes.
GN_FN vec2 gn_chs_within(vec2 right_ts, vec2 up_ts, float determinant, vec2 d_ts) {
    return vec2(d_ts.x * up_ts.y - d_ts.y * up_ts.x, right_ts.x * d_ts.y - right_ts.y * d_ts.x) / determinant;
}

// The share of a texel that lies within the kernel, by its middle q in the kernel's axes and its half side along the way to
// the rim there.
GN_FN float gn_chs_covered(bool square, vec2 q, vec2 half_side) {
    if (square) {
        vec2 covered = clamp(0.5f + 0.5f * (1.0f - abs(q)) / half_side, vec2(0.0f), vec2(1.0f));
        return covered.x * covered.y;
    }
    float far = length(q);
    float reach = far > 0.0f ? dot(abs(q), half_side) / far : half_side.x;
    return clamp(0.5f + 0.5f * (1.0f - far) / reach, 0.0f, 1.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Where kernels cross views (shadow/receiver/map_access.glsl), texels beyond the receiver's are looked up in their own.
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view

struct GnChsSum {
    float weight;
    float hidden;
    float distance;  // metres along the axis times what is hidden
};

// Adds a depth that was found at uv_ts of the tap's view, where the receiver's plane is at `plane`.
void gn_chs_add(GnLookup at, GnLookup tap, GnExtentMetres metres, vec2 middle_ts, vec2 uv_ts, float depth, float plane, float weight, inout GnChsSum sum) {
    sum.weight += weight;
    if (plane <= depth) {
        return;
    }
    float distance = gn_extent_seen(at, tap, metres, middle_ts, uv_ts, plane, depth);
    sum.hidden += weight;
    sum.distance += weight * distance;
}

// One texel of a mip, by its middle on the map.
void gn_chs_texel(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, sampler2DArray mips, GnExtentMetres metres, vec2 middle_ts, int level,
                  float weight, GnChsParams params, inout GnChsSum sum) {
    vec2 uv_ts;
    GnLookup tap = gn_tap_reader(at, middle_ts, uv_ts);
    float texel_ts = tap.projected.texel_ts;
    float side_ts = texel_ts * float(1 << level);
    vec2 last_ts = tap.projected.bounds_ts.zw - 0.5 * texel_ts;
    uv_ts = clamp(uv_ts, tap.projected.bounds_ts.xy, last_ts);
    ivec2 texel = min(ivec2(floor(uv_ts / side_ts)), max(textureSize(pyramid, 0).xy >> level, ivec2(1)) - 1);
    vec2 corner_ts = vec2(texel) * side_ts;
    vec2 centre_ts = corner_ts + 0.5 * side_ts;
    float plane = gn_depth_at(tap.projected, centre_ts, tap.bias);
    if (params.texels == GN_CHS_MEAN) {
        float mean = texelFetch(mips, ivec3(texel, tap.projected.layer), level).r;
        gn_chs_add(at, tap, metres, middle_ts, uv_ts, mean, plane, weight, sum);
        return;
    }

    // What the whole texel says; what hides the light then lies at its mean.
    int finer = min(params.finer, level);
    if (finer > 0) {
        vec2 range = texelFetch(pyramid, ivec3(texel, tap.projected.layer), level).xy;
        vec2 along = vec2(0.5, -0.5) * side_ts;
        vec4 corners = vec4(gn_depth_at(tap.projected, centre_ts + along.xx, tap.bias), gn_depth_at(tap.projected, centre_ts + along.xy, tap.bias),
                            gn_depth_at(tap.projected, centre_ts + along.yx, tap.bias), gn_depth_at(tap.projected, centre_ts + along.yy, tap.bias));
        float near = min(min(corners.x, corners.y), min(corners.z, corners.w));
        float far = max(max(corners.x, corners.y), max(corners.z, corners.w));
        float decided = gn_chs_decided(range, near, far);
        if (decided >= 0.0) {
            float mean = decided > 0.0 ? texelFetch(mips, ivec3(texel, tap.projected.layer), level).r : far;
            gn_chs_add(at, tap, metres, middle_ts, uv_ts, mean, decided > 0.0 ? far : near, weight, sum);
            return;
        }
    }

    // Look into it: points of its own, in the middles of its parts.
    int parts = 1 << finer;
    float part_ts = side_ts / float(parts);
    for (int i = 0; i < parts * parts; ++i) {
        vec2 point_ts = min(corner_ts + (vec2(i % parts, i / parts) + 0.5) * part_ts, last_ts);
        ivec2 point = ivec2(floor(point_ts / texel_ts));
        float seen = texelFetch(depth, ivec3(point, tap.projected.layer), 0).r;
        float here = gn_depth_at(tap.projected, (vec2(point) + 0.5) * texel_ts, tap.bias);
        gn_chs_add(at, tap, metres, middle_ts, point_ts, seen, here, weight / float(parts * parts), sum);
    }
}

// All texels of the mip in which `side` of them span the kernel that the light's points make through a plane at `spread`.
GnChsSum gn_chs_kernel(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, sampler2DArray mips, GnExtentLight half_light, GnExtentMetres metres, float spread,
                       GnChsParams params) {
    GnExtentKernel kernel = gn_extent_kernel(at, half_light, spread);
    GnExtentWiden widen = gn_extent_widen(kernel, 0.0, params.least * at.projected.texel_ts);
    vec4 axes_ts = gn_extent_axes(kernel);
    vec2 right_ts = axes_ts.xy + widen.right_ts;
    vec2 up_ts = axes_ts.zw + widen.up_ts;
    vec2 reach_ts = half_light.square ? abs(right_ts) + abs(up_ts) : sqrt(right_ts * right_ts + up_ts * up_ts);
    float determinant = right_ts.x * up_ts.y - right_ts.y * up_ts.x;

    // The mip, its texels that the kernel touches, and every how manieth is read where there is no mip so coarse.
    float texel_ts = at.projected.texel_ts;
    int coarsest = gn_chs_coarsest(at.projected, textureQueryLevels(pyramid));
    int level = gn_chs_level(2.0 * max(reach_ts.x, reach_ts.y) / texel_ts, params.side, coarsest);
    float cell_ts = texel_ts * float(1 << level);
    ivec2 first = ivec2(floor((at.projected.uv_ts - reach_ts) / cell_ts));
    ivec2 last = ivec2(floor((at.projected.uv_ts + reach_ts) / cell_ts));
    ivec2 stride = (last - first) / params.side + 1;

    GnChsSum sum = GnChsSum(0.0, 0.0, 0.0);
    // An edge of no length has no inside: the receiver's own texel.
    if (reach_ts == vec2(0.0)) {
        gn_chs_texel(at, depth, pyramid, mips, metres, at.projected.uv_ts, 0, 1.0, params, sum);
        return sum;
    }
    float least_area = 1.0e-3 * cell_ts * cell_ts;
    determinant = abs(determinant) > least_area ? determinant : determinant < 0.0 ? -least_area : least_area;
    vec2 u = gn_chs_within(right_ts, up_ts, determinant, vec2(0.5 * cell_ts * float(stride.x), 0.0));
    vec2 v = gn_chs_within(right_ts, up_ts, determinant, vec2(0.0, 0.5 * cell_ts * float(stride.y)));
    vec2 half_side = abs(u) + abs(v);
    for (int y = first.y; y <= last.y; y += stride.y) {
        for (int x = first.x; x <= last.x; x += stride.x) {
            vec2 middle_ts = (vec2(x, y) + 0.5 * vec2(stride)) * cell_ts;
            vec2 q = gn_chs_within(right_ts, up_ts, determinant, middle_ts - at.projected.uv_ts);
            float weight = gn_chs_covered(half_light.square, q, half_side);
            if (weight > 0.0) {
                gn_chs_texel(at, depth, pyramid, mips, metres, middle_ts, level, weight, params, sum);
            }
        }
    }
    return sum;
}

float gn_chs_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, sampler2DArray mips, GnChsParams params) {
    GnExtentLight half_light = gn_extent_light(at.light, at.receiver.p_ws);
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnExtentRegion region = gn_extent_region(at, pyramid, half_light, metres, params.least, params.early_out != 0);
    if (region.visibility >= 0.0) {
        return region.visibility;
    }
    GnChsSum search = gn_chs_kernel(at, depth, pyramid, mips, half_light, metres, region.spread, params);
    if (search.hidden <= 0.0) {
        return 1.0;
    }
    float blocker = clamp(search.distance / search.hidden, 0.0, region.receiver);
    GnChsSum filtered = gn_chs_kernel(at, depth, pyramid, mips, half_light, metres, gn_extent_spread_at(at, region.receiver, blocker), params);
    return filtered.weight > 0.0 ? 1.0 - filtered.hidden / filtered.weight : 1.0;
}
#endif

#endif
