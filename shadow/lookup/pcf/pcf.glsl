// SPDX-License-Identifier: MIT
// Percentage-closer filtering: compare first, then average.
// Based on: Reeves, Salesin, Cook. Rendering Antialiased Shadows with Depth Maps. SIGGRAPH 1987. [RSC87]
// The pixel's footprint: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008.
// [Lau08], 2.3.
// Departs from them: grid kernels are separable weights over gathered texels, and take the rectangle around the footprint;
// disc kernels use fixed sets of taps, each of one texel or of the four around it.
#ifndef GN_SHADOW_LOOKUP_PCF_GLSL
#define GN_SHADOW_LOOKUP_PCF_GLSL

#include "shadow/lookup/pcf/pcf.h"
#include "shadow/receiver/noise.glsl"
#include "shadow/receiver/bilinear_tap.glsl"
#include "shadow/receiver/confidence.glsl"
#include "shadow/receiver/region_extremes.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Size of a grid kernel: the named ones have their own, the n x n ones take the parameter.
GN_FN int gn_pcf_size(int kernel, int size) {
    if (kernel == GN_PCF_2X2) {
        return 2;
    }
    return kernel == GN_PCF_3X3 ? 3 : kernel == GN_PCF_BILINEAR ? 1 : size;
}

// Whether a grid kernel weighs whole texels equally; the others follow the receiver continuously.
GN_FN bool gn_pcf_snapped(int kernel) { return kernel <= GN_PCF_NXN; }

// Texels along one side of a grid kernel's footprint, rounded up to whole gathers of 2 x 2.
GN_FN int gn_pcf_footprint(int kernel, int size) {
    int texels = gn_pcf_snapped(kernel) ? size : size + 1;
    return texels + texels % 2;
}

// First texel of the footprint along one axis, for a receiver at `t` (in texels; texel i spans [i, i+1)).
GN_FN int gn_pcf_first(int kernel, int size, float t) {
    if (gn_pcf_snapped(kernel)) {
        // Odd sizes centre on the receiver's texel, even ones on the nearest corner.
        return size % 2 == 1 ? int(floor(t)) - size / 2 : int(floor(t + 0.5f)) - size / 2;
    }
    // size bilinear taps one texel apart, centred on the receiver.
    return int(floor(t - 0.5f * float(size)));
}

// Weight of footprint texel i (0 is gn_pcf_first) along one axis; the weights of an axis sum to one.
GN_FN float gn_pcf_weight(int kernel, int size, float t, int i) {
    if (gn_pcf_snapped(kernel)) {
        return i < size ? 1.0f / float(size) : 0.0f;
    }
    // A box of `size` texels around t, intersected with texel i: what `size` bilinear taps average.
    // Measured from the footprint's first texel: within thousands of texels a float's step would show in the sum.
    float start = t - 0.5f * float(size);
    float into = start - floor(start);
    float covered = min(float(i) + 1.0f, into + float(size)) - max(float(i), into);
    return clamp(covered, 0.0f, 1.0f) / float(size);
}

// Gaussian of sigma = size / 3 over the same texels, not normalized. [Cas13] packs the like into bilinear fetches.
GN_FN float gn_pcf_gaussian(int size, float t, int i) {
    float position = floor(t - 0.5f * float(size)) + float(i) + 0.5f;
    float sigma = float(size) / 3.0f;
    float x = (position - t) / sigma;
    return i <= size ? exp(-0.5f * x * x) : 0.0f;
}

// Texels of the map that a grid kernel covers along one axis, from `low` to `high`, around the receiver at `centre`.
struct GnPcfSpan {
    float low;
    float high;
    float centre;
    float size;  // of the kernel or of the pixel's footprint, whichever is larger, before the map's border cuts it
};

// A kernel of `size` texels and a footprint of `pixel` texels, cut at the view's rectangle from `first` to `end`: beyond it
// the map has no depths, and the weights of the rest sum to one. [Lau08] 2.3
GN_FN GnPcfSpan gn_pcf_span(int kernel, int size, float pixel, float t, float first, float end) {
    GnPcfSpan span;
    span.size = max(float(size), pixel);
    span.centre = t;
    float low = t - 0.5f * span.size;
    float high = t + 0.5f * span.size;
    if (gn_pcf_snapped(kernel)) {
        // Whole texels, as many as hold the footprint.
        int texels = int(min(ceil(span.size), 2.0f * (end - first) + 2.0f));
        low = float(gn_pcf_first(kernel, texels, t));
        high = low + float(texels);
    } else if (kernel == GN_PCF_GAUSSIAN) {
        low = floor(low);
        high = floor(high) + 1.0f;
    }
    span.low = clamp(low, first, end - 1.0f);
    span.high = clamp(high, span.low, end);
    return span;
}

// Weight of the texel that spans [texel, texel + 1), not normalized.
GN_FN float gn_pcf_span_weight(int kernel, GnPcfSpan span, float texel) {
    float covered = clamp(min(texel + 1.0f, span.high) - max(texel, span.low), 0.0f, 1.0f);
    if (kernel != GN_PCF_GAUSSIAN) {
        return covered;
    }
    float x = (texel + 0.5f - span.centre) / (span.size / 3.0f);
    return covered > 0.0f ? exp(-0.5f * x * x) : 0.0f;
}

// Where tap i looks within the pixel, in pixels from its centre: additive recurrence by the plastic number, which fills the
// square evenly whatever the count.
GN_FN vec2 gn_pcf_subpixel(int i) {
    return fract(vec2(0.75487767f, 0.56984029f) * float(i) + 0.5f) - 0.5f;
}

// An angle per pixel.
GN_FN float gn_pcf_angle(vec2 p_ss) { return 6.28318531f * gn_gradient_noise(p_ss); }

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// The host may list the taps of a set on the unit disc, made beforehand, four at a time: GN_PCF_PROBES(take) and
// GN_PCF_OTHERS(take) expand to take(x, y, counted) for the first eight and for the rest. Without them the spiral serves.
//   #define GN_PCF_PROBES(take) take(vec4(0.1), vec4(0.2), vec4(1.0))
//   with #define GN_PCF_OTHERS(take) take(vec4(0.3), vec4(0.4), vec4(1.0))
// The host may fix the kernel and the loops' counts when it compiles.
//   #define GN_PCF_KERNEL GN_PCF_3X3
//   #define GN_PCF_SIZE 3
//   #define GN_PCF_FOOTPRINT 4
//   #define GN_PCF_TAPS 16
//   #define GN_PCF_EARLY_OUT true
//   #define GN_PCF_OVER_PIXEL false
//   #define GN_PCF_TAP GN_PCF_ONE_TEXEL
#ifndef GN_PCF_FOOTPRINT
#define GN_PCF_FOOTPRINT gn_pcf_footprint(params.kernel, params.size)
#endif
#ifndef GN_PCF_TAPS
#define GN_PCF_TAPS params.taps
#endif
#ifndef GN_PCF_KERNEL
#define GN_PCF_KERNEL params.kernel
#endif
#ifndef GN_PCF_SIZE
#define GN_PCF_SIZE gn_pcf_size(params.kernel, params.size)
#endif

#ifndef GN_PCF_EARLY_OUT
#define GN_PCF_EARLY_OUT (params.early_out != 0)
#endif
#ifndef GN_PCF_TAP
#define GN_PCF_TAP params.tap
#endif
#ifndef GN_PCF_OVER_PIXEL
#define GN_PCF_OVER_PIXEL (params.footprint == GN_PCF_OF_PIXEL)
#endif

// Where a host draws ids, `ids` holds them, and an object never shadows itself [HN85]; else nothing reads `ids`:
//   #define GN_CASTER_IDS
// Where kernels cross views (shadow/receiver/map_access.glsl), taps beyond the receiver's are compared one by one.
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view
vec4 gn_pcf_gather(GnLookup at, sampler2DArray depth, sampler2DArray ids, vec2 corner_ts) {
    vec4 lit = gn_lit_gather(depth, at, corner_ts);
#ifdef GN_CASTER_IDS
    if (gn_gathers_within(at.projected, corner_ts)) {
        vec4 casters = gn_map_gather(ids, at, corner_ts);
        lit = max(lit, vec4(equal(casters, vec4(float(at.receiver.object)))));
    }
#endif
    return lit;
}

float gn_pcf_axis_weight(GnPcfParams params, float t, int i) {
    return params.kernel == GN_PCF_GAUSSIAN ? gn_pcf_gaussian(params.size, t, i)
                                            : gn_pcf_weight(params.kernel, params.size, t, i);
}

// The four texels of a gather by the weights of their columns and rows.
float gn_pcf_weighed(vec4 lit, vec2 wx, vec2 wy) {
    return dot(lit, vec4(wx.x, wx.y, wx.y, wx.x) * vec4(wy.y, wy.y, wy.x, wy.x));
}

// Gather the footprint in blocks of 2 x 2 texels and weigh each comparison by its row and column.
float gn_pcf_grid(GnLookup at, sampler2DArray depth, sampler2DArray ids, GnPcfParams params) {
    vec2 t = at.projected.uv_ts / at.projected.texel_ts;
    ivec2 first = ivec2(gn_pcf_first(params.kernel, params.size, t.x), gn_pcf_first(params.kernel, params.size, t.y));
    vec2 first_ts = vec2(first + 1) * at.projected.texel_ts;
    float sum = 0.0;
    float total = 0.0;
    for (int y = 0; y < GN_PCF_FOOTPRINT; y += 2) {
        vec2 wy = vec2(gn_pcf_axis_weight(params, t.y, y), gn_pcf_axis_weight(params, t.y, y + 1));
        for (int x = 0; x < GN_PCF_FOOTPRINT; x += 2) {
            vec2 wx = vec2(gn_pcf_axis_weight(params, t.x, x), gn_pcf_axis_weight(params, t.x, x + 1));
            // Components of a gather: x (0,1), y (1,1), z (1,0), w (0,0).
            vec2 corner_ts = first_ts + vec2(x, y) * at.projected.texel_ts;
            vec4 lit = gn_pcf_gather(at, depth, ids, corner_ts);
            sum += gn_pcf_weighed(lit, wx, wy);
            total += (wx.x + wx.y) * (wy.x + wy.y);
        }
    }
    return params.kernel == GN_PCF_GAUSSIAN ? sum / total : sum;
}

// A step of a pixel of the picture, on the map.
vec2 gn_pcf_step(GnProjected projected, vec3 step_ws) {
    return vec2(dot(projected.du_ws, step_ws), dot(projected.dv_ws, step_ws));
}

// The same over all texels of the rectangle around what the kernel and the pixel cover.
float gn_pcf_grid_over_pixel(GnLookup at, sampler2DArray depth, sampler2DArray ids, GnPcfParams params) {
    vec2 t = at.projected.uv_ts / at.projected.texel_ts;
    vec2 pixel = (abs(gn_pcf_step(at.projected, at.receiver.ddx_ws)) + abs(gn_pcf_step(at.projected, at.receiver.ddy_ws))) / at.projected.texel_ts;
    vec4 border = round(at.projected.bounds_ts / at.projected.texel_ts);
    GnPcfSpan across = gn_pcf_span(params.kernel, params.size, pixel.x, t.x, border.x, border.z);
    GnPcfSpan down = gn_pcf_span(params.kernel, params.size, pixel.y, t.y, border.y, border.w);
    float sum = 0.0;
    float total = 0.0;
    for (float y = floor(down.low); y < down.high; y += 2.0) {
        vec2 wy = vec2(gn_pcf_span_weight(params.kernel, down, y), gn_pcf_span_weight(params.kernel, down, y + 1.0));
        for (float x = floor(across.low); x < across.high; x += 2.0) {
            vec2 wx = vec2(gn_pcf_span_weight(params.kernel, across, x), gn_pcf_span_weight(params.kernel, across, x + 1.0));
            vec4 lit = gn_pcf_gather(at, depth, ids, (vec2(x, y) + 1.0) * at.projected.texel_ts);
            sum += gn_pcf_weighed(lit, wx, wy);
            total += (wx.x + wx.y) * (wy.x + wy.y);
        }
    }
    return sum / total;
}

// Four taps of a disc kernel: the texels that they fall into, compared at the texels' centres.
vec4 gn_pcf_taps(GnLookup at, sampler2DArray depth, sampler2DArray ids, vec4 u_ts, vec4 v_ts) {
#ifdef GN_CROSSING
    vec2 low_ts = vec2(min(min(u_ts.x, u_ts.y), min(u_ts.z, u_ts.w)), min(min(v_ts.x, v_ts.y), min(v_ts.z, v_ts.w)));
    vec2 high_ts = vec2(max(max(u_ts.x, u_ts.y), max(u_ts.z, u_ts.w)), max(max(v_ts.x, v_ts.y), max(v_ts.z, v_ts.w)));
    if (!gn_within_view(at.projected, low_ts, high_ts)) {
        vec4 across;
        for (int k = 0; k < 4; ++k) {
            across[k] = float(gn_lit_tap(depth, at, vec2(u_ts[k], v_ts[k])));
        }
        return across;
    }
#endif
    vec2 last_ts = at.projected.bounds_ts.zw - 0.5 * at.projected.texel_ts;
    vec4 u = floor(clamp(u_ts, at.projected.bounds_ts.x, last_ts.x) / at.projected.texel_ts);
    vec4 v = floor(clamp(v_ts, at.projected.bounds_ts.y, last_ts.y) / at.projected.texel_ts);
    vec4 occluder;
    vec4 own = vec4(0.0);
    for (int k = 0; k < 4; ++k) {
        occluder[k] = gn_map_texel(depth, at, ivec2(u[k], v[k])).r;
#ifdef GN_CASTER_IDS
        own[k] = float(gn_map_texel(ids, at, ivec2(u[k], v[k])).r == float(at.receiver.object));
#endif
    }
    vec4 lit = vec4(gn_lit_at(at.projected, (u + 0.5) * at.projected.texel_ts, (v + 0.5) * at.projected.texel_ts, occluder, at.bias));
    return max(lit, own);
}

// The share of each that is lit, of the four texels around it.
vec4 gn_pcf_bilinear_taps(GnLookup at, sampler2DArray depth, sampler2DArray ids, vec4 u_ts, vec4 v_ts) {
    vec4 lit;
    for (int k = 0; k < 4; ++k) {
        GnBilinear tap = gn_bilinear_in_view(at.projected, vec2(u_ts[k], v_ts[k]));
        lit[k] = gn_bilinear_mean(gn_pcf_gather(at, depth, ids, tap.corner_ts), tap.share);
    }
    return lit;
}

// How many of four taps are lit, the first of them tap `first`: their points on the unit disc, turned and scaled; `counted`
// is 1 or 0 each. Over the pixel each tap looks from another place in it.
float gn_pcf_four(GnLookup at, sampler2DArray depth, sampler2DArray ids, GnPcfParams params,
                  vec2 radius_ts, vec2 turn, int first, vec4 x, vec4 y, vec4 counted) {
    vec4 u_ts = at.projected.uv_ts.x + radius_ts.x * (turn.x * x - turn.y * y);
    vec4 v_ts = at.projected.uv_ts.y + radius_ts.y * (turn.y * x + turn.x * y);
    if (GN_PCF_OVER_PIXEL) {
        vec2 right_ts = gn_pcf_step(at.projected, at.receiver.ddx_ws);
        vec2 below_ts = gn_pcf_step(at.projected, at.receiver.ddy_ws);
        for (int k = 0; k < 4; ++k) {
            vec2 p_ss = gn_pcf_subpixel(first + k);
            vec2 d_ts = p_ss.x * right_ts + p_ss.y * below_ts;
            u_ts[k] += d_ts.x;
            v_ts[k] += d_ts.y;
        }
    }
    return dot(counted, GN_PCF_TAP == GN_PCF_FOUR_TEXELS ? gn_pcf_bilinear_taps(at, depth, ids, u_ts, v_ts)
                                                         : gn_pcf_taps(at, depth, ids, u_ts, v_ts));
}

#ifndef GN_PCF_PROBES
float gn_pcf_spiral(GnLookup at, sampler2DArray depth, sampler2DArray ids, GnPcfParams params,
                    vec2 radius_ts, vec2 turn, int taps, int first, int end) {
    float sum = 0.0;
    for (int i = first; i < end; i += 4) {
        vec4 x;
        vec4 y;
        for (int k = 0; k < 4; ++k) {
            vec2 p = gn_vogel(i + k, taps, 0.0);
            x[k] = p.x;
            y[k] = p.y;
        }
        vec4 counted = vec4(lessThan(i + ivec4(0, 1, 2, 3), ivec4(taps)));
        sum += gn_pcf_four(at, depth, ids, params, radius_ts, turn, i, x, y, counted);
    }
    return sum;
}
#endif

// The radius of a disc kernel on the map.
vec2 gn_pcf_radius(GnLookup at, GnPcfParams params) {
    return params.radius_world > 0.0 ? gn_texels(at.projected, params.radius_world) * at.projected.texel_ts
                                     : vec2(params.radius * at.projected.texel_ts);
}

float gn_pcf_discs(GnLookup at, sampler2DArray depth, sampler2DArray ids, GnPcfParams params) {
    vec2 radius_ts = gn_pcf_radius(at, params);
    float angle = params.kernel == GN_PCF_POISSON ? 0.0 : gn_pcf_angle(at.receiver.p_ss);
    vec2 turn = vec2(cos(angle), sin(angle));
    int probes = min(GN_PCF_TAPS, 8);
    float sum = 0.0;
#ifdef GN_PCF_PROBES
    int tap = 0;
#define GN_PCF_TAKE(x, y, counted)                                                                   \
    sum += gn_pcf_four(at, depth, ids, params, radius_ts, turn, tap, x, y, counted); \
    tap += 4;
    GN_PCF_PROBES(GN_PCF_TAKE)
#else
    sum = gn_pcf_spiral(at, depth, ids, params, radius_ts, turn, GN_PCF_TAPS, 0, probes);
#endif

    // Two steps: where the first taps agree, the rest would. (Uralsky's early out, [EASW09] 4.2)
    if (GN_PCF_EARLY_OUT && (sum == 0.0 || sum == float(probes))) {
        return sum / float(probes);
    }
#ifdef GN_PCF_PROBES
    GN_PCF_OTHERS(GN_PCF_TAKE)
#undef GN_PCF_TAKE
#else
    sum += gn_pcf_spiral(at, depth, ids, params, radius_ts, turn, GN_PCF_TAPS, probes, GN_PCF_TAPS);
#endif
    return sum / float(GN_PCF_TAPS);
}

// Least and greatest depths, which may say at once what all taps would:
//   #define GN_PCF_EXTREMES
#ifdef GN_PCF_EXTREMES
#define GN_PCF_MAPS sampler2DArray depth, sampler2DArray pyramid, sampler2DArray ids

// How far from the receiver the kernel reads texels, on each side.
vec2 gn_pcf_reach(GnLookup at, GnPcfParams params) {
    vec2 right_ts = abs(gn_pcf_step(at.projected, at.receiver.ddx_ws));
    vec2 below_ts = abs(gn_pcf_step(at.projected, at.receiver.ddy_ws));
    if (params.kernel > GN_PCF_GAUSSIAN) {
        float beside_ts = GN_PCF_TAP == GN_PCF_FOUR_TEXELS ? at.projected.texel_ts : 0.0;
        return gn_pcf_radius(at, params) + beside_ts + (GN_PCF_OVER_PIXEL ? 0.5 * (right_ts + below_ts) : vec2(0.0));
    }
    vec2 side = vec2(gn_pcf_footprint(params.kernel, params.size));
    if (GN_PCF_OVER_PIXEL) {
        side = max(side, (right_ts + below_ts) / at.projected.texel_ts) + 2.0;
    }
    return (0.5 * side + 1.0) * at.projected.texel_ts;
}

// 1 where all that the kernel reads leaves the receiver's plane lit, 0 where all of it hides the plane, else -1. [AHH18] 7.6
// What hides it may be the receiver's own object, which ids let through.
float gn_pcf_agreed(GnLookup at, sampler2DArray pyramid, GnPcfParams params) {
    float agreed = gn_region_extremes(at, pyramid, gn_pcf_reach(at, params)).y;
#ifdef GN_CASTER_IDS
    return agreed == 1.0 ? 1.0 : -1.0;
#else
    return agreed;
#endif
}
#else
#define GN_PCF_MAPS sampler2DArray depth, sampler2DArray ids
#endif

float gn_pcf_visibility(GnLookup at, GN_PCF_MAPS, GnPcfParams params) {
    params.kernel = GN_PCF_KERNEL;
    params.size = GN_PCF_SIZE;
#ifdef GN_PCF_EXTREMES
    float agreed = gn_pcf_agreed(at, pyramid, params);
    if (agreed >= 0.0) {
        return agreed;
    }
#endif
    if (params.kernel > GN_PCF_GAUSSIAN) {
        return gn_pcf_discs(at, depth, ids, params);
    }
    return GN_PCF_OVER_PIXEL ? gn_pcf_grid_over_pixel(at, depth, ids, params)
                             : gn_pcf_grid(at, depth, ids, params);
}

// How near the texel's centre lies, and how far around the sample casters change its V.
float gn_pcf_confidence(GnLookup at, GN_PCF_MAPS, GnPcfParams params) { return gn_confidence(at.projected); }
float gn_pcf_kernel_reach(GnLookup at, GN_PCF_MAPS, GnPcfParams params) { return gn_kernel_reach(at.projected, at.bias); }
#endif

#endif
