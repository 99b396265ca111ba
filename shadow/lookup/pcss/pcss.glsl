// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows: search for what hides the light, guess the penumbra from how far away it is, filter as wide.
// Based on: Fernando. Percentage-Closer Soft Shadows. SIGGRAPH Sketches 2005. [Fer05]
// Penumbrae and what the search assumes: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia
// Courses 2009. [EASW09], 5.2.2.
// Departs from them: taps are points of the light itself, in its own shape and place, as the receiver sees them through a
// plane at the blockers' depth; a pyramid of least and greatest depths narrows the search and ends it early.
#ifndef GN_SHADOW_LOOKUP_PCSS_GLSL
#define GN_SHADOW_LOOKUP_PCSS_GLSL

#include "shadow/lookup/pcss/pcss.h"
#include "shadow/map/derived.glsl"
#include "shadow/receiver/map_access.glsl"
#include "shadow/receiver/noise.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Half the light as the receiver sees it: a point of it is x right + y up from its centre, x and y in [-1,1], within the
// unit disc unless it is square. Metres; of a sun tangents, metres for each metre that a blocker lies before the receiver.
struct GnPcssLight {
    vec3 right_ws;
    vec3 up_ws;
    bool square;
};

// Two axes across a unit vector. [Duff et al. 2017]
GN_FN void gn_pcss_axes(vec3 n, GN_OUT(vec3) right, GN_OUT(vec3) up) {
    float side = n.z >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (side + n.z);
    float b = n.x * n.y * a;
    right = vec3(1.0f + side * n.x * n.x * a, side * b, -side * n.x);
    up = vec3(b, side + n.y * n.y * a, -n.y);
}

GN_FN GnPcssLight gn_pcss_light(GnLight light, vec3 p_ws) {
    GnPcssLight half_light;
    half_light.square = light.kind == uint(GN_LIGHT_RECTANGLE);
    if (half_light.square) {
        half_light.right_ws = vec3(light.right_ws) * light.half_size.x;
        half_light.up_ws = vec3(light.up_ws) * light.half_size.y;
        return half_light;
    }
    vec3 right_ws;
    vec3 up_ws;
    // A spot is a disc across its axis; spheres and suns turn their disc to the receiver.
    gn_pcss_axes(light.kind == uint(GN_LIGHT_SPOT) ? vec3(light.direction_ws) : gn_to_light(light, p_ws), right_ws, up_ws);
    float radius = light.kind == uint(GN_LIGHT_DIRECTIONAL) ? tan(light.angular_radius) : light.radius;
    half_light.right_ws = right_ws * radius;
    half_light.up_ws = up_ws * radius;
    return half_light;
}

// Where distances are measured along, unit, away from the light: across the disc or rectangle that stands for it.
GN_FN vec3 gn_pcss_axis(GnLight light, vec3 p_ws) {
    bool flat_light = light.kind == uint(GN_LIGHT_RECTANGLE) || light.kind == uint(GN_LIGHT_SPOT);
    return flat_light ? vec3(light.direction_ws) : -gn_to_light(light, p_ws);
}

// Metres along the axis from the light to what a tap holds at a linear depth; of a sun from the view's near plane.
GN_FN float gn_pcss_distance(GnLightView view, vec3 axis, vec2 uv_ts, float depth) {
    if (view.eye_ws.w <= 0.5f || gn_bent(view)) {
        return depth * view.metres_per_depth;
    }
    vec2 p_ndc = (uv_ts - vec2(view.rect_ts.x, view.rect_ts.y)) / vec2(view.rect_ts.z, view.rect_ts.w) * 2.0f - 1.0f;
    vec4 seen_ws = view.ws_from_cs * vec4(p_ndc.x, p_ndc.y, 0.5f, 1.0f);
    vec3 ray_ws = vec3(seen_ws) / seen_ws.w - vec3(view.eye_ws);
    float eye = dot(view.depth_from_ws, vec4(vec3(view.eye_ws), 1.0f));
    return dot(axis, ray_ws) * (depth - eye) / dot(vec3(view.depth_from_ws), ray_ws);
}

// What a receiver at `receiver` metres sees of the light's extent moves by over the receiver, for a blocker at `blocker`
// metres: w_p / w_l = (d_r - d_o) / d_o, of a sun the distance between them. [EASW09] 5.2.2
GN_FN float gn_pcss_spread(bool far, float receiver, float blocker) {
    float between = max(receiver - blocker, 0.0f);
    return far ? between : between / max(blocker, 1.0e-3f * receiver);
}

// How much wider than a sphere the disc through its centre is that gives the same penumbra for a blocker at `blocker` metres
// from the centre: it of a sphere is 2 r (d_r - d_o) / sqrt(d_o^2 - r^2) wide.
GN_FN float gn_pcss_bulge(float radius, float blocker) {
    float share = min(radius / max(blocker, 1.0e-6f), 0.95f);
    return 1.0f / sqrt(1.0f - share * share);
}

// Where on the map the receiver sees point q of the light through a plane across the axis: seen from the light's centre it is
// where the receiver would be if it moved by `spread` times the point. From the receiver's own place.
GN_FN vec2 gn_pcss_shift(GnLookup at, GnPcssLight half_light, vec2 q, float spread) {
    vec3 point_ws = q.x * half_light.right_ws + q.y * half_light.up_ws;
    vec3 way_ws = spread * point_ws;
    float fall = gn_bent(at.view) ? 0.0f : dot(gn_row(at.view.cs_from_ws, 3), way_ws) / gn_clip(at.view, at.receiver.p_ws).w;
    return vec2(dot(at.projected.du_ws, way_ws), dot(at.projected.dv_ws, way_ws)) / max(1.0f + fall, 0.1f);
}

// Half the sides of the rectangle of the map around all such points.
GN_FN vec2 gn_pcss_reach(GnLookup at, GnPcssLight half_light, float spread) {
    vec2 right_ts = abs(gn_pcss_shift(at, half_light, vec2(1.0f, 0.0f), spread));
    vec2 up_ts = abs(gn_pcss_shift(at, half_light, vec2(0.0f, 1.0f), spread));
    return half_light.square ? right_ts + up_ts : sqrt(right_ts * right_ts + up_ts * up_ts);
}

// Point i of n in the light's own shape, turned or moved by the pixel's noise.
GN_FN vec2 gn_pcss_point(bool square, int i, int n, float noise) {
    if (square) {
        vec2 cell = vec2(0.75487767f, 0.56984029f) * float(i) + vec2(noise, fract(7.0f * noise + 0.5f));
        return 2.0f * fract(cell) - 1.0f;
    }
    return gn_vogel(i, n, 6.28318531f * noise);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Where kernels cross views (shadow/receiver/map_access.glsl), taps beyond the receiver's are looked up in their own.
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view

struct GnPcssTap {
    float occluder;  // linear depth in the receiver's own view
    bool lit;
};

GnPcssTap gn_pcss_tap(GnLookup at, sampler2DArray depth, vec2 tap_ts) {
    GnLookup tap = at;
    vec2 uv_ts = tap_ts;
#ifdef GN_CROSSING
    if (!gn_within_view(at.projected, tap_ts, tap_ts)) {
        tap = gn_at_tap(at, tap_ts);
        uv_ts = tap.receiver.p_ws == at.receiver.p_ws ? tap_ts : tap.projected.uv_ts;
    }
#endif
    vec2 last_ts = tap.projected.bounds_ts.zw - 0.5 * tap.projected.texel_ts;
    ivec2 texel = ivec2(floor(clamp(uv_ts, tap.projected.bounds_ts.xy, last_ts) / tap.projected.texel_ts));
    float occluder = gn_map_texel(depth, tap, texel).r;
    float plane = gn_depth_at(tap.projected, (vec2(texel) + 0.5) * tap.projected.texel_ts, tap.bias);
    bool lit = plane <= occluder;
#ifdef GN_CROSSING
    // As much nearer than the receiver's plane in its own view as in the tap's.
    float nearer = (plane - occluder) * tap.projected.metres_per_depth / at.projected.metres_per_depth;
    occluder = gn_depth_at(at.projected, tap_ts, at.bias) - nearer;
#endif
    return GnPcssTap(occluder, lit);
}

// What the rectangle around the light's points holds through a plane at `spread`: the least depth, and whether all of it or
// none of it hides the receiver's plane (1, 0), else -1.
vec2 gn_pcss_extremes(GnLookup at, sampler2DArray pyramid, vec2 reach_ts) {
    vec2 low_ts = at.projected.uv_ts - reach_ts;
    vec2 high_ts = at.projected.uv_ts + reach_ts;
    vec2 first_ts = max(low_ts, at.projected.bounds_ts.xy);
    vec2 last_ts = min(high_ts, at.projected.bounds_ts.zw - 0.5 * at.projected.texel_ts);
    ivec2 first = ivec2(floor(first_ts / at.projected.texel_ts));
    ivec2 last = max(ivec2(floor(last_ts / at.projected.texel_ts)), first);
    vec2 found = gn_pyramid_min_max(pyramid, first, last, at.projected.layer, textureQueryLevels(pyramid));
    if (!gn_within_view(at.projected, low_ts, high_ts)) {
        return vec2(found.x, -1.0);
    }
    // The plane is flat between its corners; a cone lies below it, deepest at the corners.
    vec2 corner_ts = reach_ts + at.projected.texel_ts;
    float nearest = 1.0e30;
    float farthest = -1.0e30;
    for (int k = 0; k < 4; ++k) {
        vec2 d_ts = corner_ts * vec2((k & 1) == 0 ? -1.0 : 1.0, (k & 2) == 0 ? -1.0 : 1.0);
        float plane = gn_depth_at(at.projected, at.projected.uv_ts + d_ts, at.bias);
        nearest = min(nearest, plane);
        farthest = max(farthest, plane + gn_cone(at.projected, d_ts));
    }
    return vec2(found.x, farthest <= found.x ? 1.0 : nearest > found.y ? 0.0 : -1.0);
}

// What of the light's extent is between receiver and blockers.
float gn_pcss_spread_at(GnLookup at, float receiver, float blocker) {
    float spread = gn_pcss_spread(at.view.eye_ws.w <= 0.5, receiver, blocker);
    return at.light.kind == uint(GN_LIGHT_POINT) ? spread * gn_pcss_bulge(at.light.radius, blocker) : spread;
}

struct GnPcssFound {
    float visibility;  // 0 or 1 where the extremes decide or nothing was found, else -1
    float receiver;    // metres along the axis
    float blocker;
};

GnPcssFound gn_pcss_search(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnPcssLight half_light,
                           GnPcssParams params, float noise) {
    vec3 axis = gn_pcss_axis(at.light, at.receiver.p_ws);
    GnPcssFound result;
    result.visibility = -1.0;
    result.receiver = gn_pcss_distance(at.view, axis, at.projected.uv_ts, at.projected.depth);
    result.blocker = result.receiver;

    // From the nearest that the whole view holds, then from the nearest in the region that follows from it.
    vec2 least_ts = vec2(params.least * at.projected.texel_ts);
    vec2 found = gn_pcss_extremes(at, pyramid, at.projected.bounds_ts.zw - at.projected.bounds_ts.xy);
    float spread = 0.0;
    for (int step = 0; step < 3; ++step) {
        float nearest = gn_pcss_distance(at.view, axis, at.projected.uv_ts, max(found.x, 0.0));
        spread = gn_pcss_spread_at(at, result.receiver, nearest);
        found = gn_pcss_extremes(at, pyramid, gn_pcss_reach(at, half_light, spread) + least_ts);
        if (found.y >= 0.0 && params.early_out != 0) {
            result.visibility = found.y;
            return result;
        }
    }

    float sum = 0.0;
    float count = 0.0;
    float nearest = result.receiver;
    for (int i = 0; i < params.search_taps; ++i) {
        vec2 q = gn_pcss_point(half_light.square, i, params.search_taps, noise);
        vec2 tap_ts = at.projected.uv_ts + gn_pcss_shift(at, half_light, q, spread) + q * least_ts;
        GnPcssTap tap = gn_pcss_tap(at, depth, tap_ts);
        if (!tap.lit) {
            float distance = gn_pcss_distance(at.view, axis, tap_ts, tap.occluder);
            sum += distance;
            count += 1.0;
            nearest = min(nearest, distance);
        }
    }
    if (count == 0.0) {
        result.visibility = 1.0;
        return result;
    }
    result.blocker = clamp(params.blocker == GN_PCSS_NEAREST ? nearest : sum / count, 0.0, result.receiver);
    return result;
}

float gn_pcss_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnPcssParams params) {
    GnPcssLight half_light = gn_pcss_light(at.light, at.receiver.p_ws);
    float noise = gn_gradient_noise(at.receiver.p_ss);
    GnPcssFound found = gn_pcss_search(at, depth, pyramid, half_light, params, noise);
    if (found.visibility >= 0.0) {
        return found.visibility;
    }
    float spread = gn_pcss_spread_at(at, found.receiver, found.blocker);
    vec2 reach = gn_pcss_reach(at, half_light, spread) / at.projected.texel_ts;
    vec2 least_ts = max(params.least - reach, 0.0) * at.projected.texel_ts;
    float width = max(max(reach.x, reach.y), params.least);
    int taps = clamp(int(ceil(params.density * width)), min(4, params.taps), params.taps);
    float lit = 0.0;
    for (int i = 0; i < taps; ++i) {
        vec2 q = gn_pcss_point(half_light.square, i, taps, noise);
        vec2 tap_ts = at.projected.uv_ts + gn_pcss_shift(at, half_light, q, spread) + q * least_ts;
        lit += gn_pcss_tap(at, depth, tap_ts).lit ? 1.0 : 0.0;
    }
    return lit / float(taps);
}

// Metres along the axis from the receiver to what hides the light from it; 0 where nothing does.
float gn_pcss_blocker_distance(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnPcssParams params) {
    params.early_out = 0;
    GnPcssLight half_light = gn_pcss_light(at.light, at.receiver.p_ws);
    GnPcssFound found = gn_pcss_search(at, depth, pyramid, half_light, params, gn_gradient_noise(at.receiver.p_ss));
    return found.visibility >= 0.0 ? 0.0 : found.receiver - found.blocker;
}

// Metres across the penumbra, where it lies across the axis; 0 where nothing hides the light.
float gn_pcss_penumbra_width(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnPcssParams params) {
    params.early_out = 0;
    GnPcssLight half_light = gn_pcss_light(at.light, at.receiver.p_ws);
    GnPcssFound found = gn_pcss_search(at, depth, pyramid, half_light, params, gn_gradient_noise(at.receiver.p_ss));
    float half_width = max(length(half_light.right_ws), length(half_light.up_ws));
    return found.visibility >= 0.0 ? 0.0 : 2.0 * half_width * gn_pcss_spread_at(at, found.receiver, found.blocker);
}
#endif

#endif
