// SPDX-License-Identifier: MIT
// The light as a receiver sees it through the map: how far blockers spread its points, and where what hides it can lie.
// Compiles as GLSL and as C++ (the tests check its laws on the CPU).
// Penumbrae: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09], 5.2.2.
#ifndef GN_SHADOW_LOOKUP_PCSS_LIGHT_GLSL
#define GN_SHADOW_LOOKUP_PCSS_LIGHT_GLSL

#include "shadow/receiver/map_range.glsl"
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
    vec2 p_ndc = gn_ndc_at(view, uv_ts);
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

// Metres across the penumbra of what spreads the light's points so, where it lies across the axis.
GN_FN float gn_pcss_width(GnPcssLight half_light, float spread) {
    return 2.0f * max(length(half_light.right_ws), length(half_light.up_ws)) * spread;
}

// Where on the map the receiver sees point q of the light through a plane across the axis: seen from the light's centre it is
// where the receiver would be if it moved by `spread` times the point. From the receiver's own place.
GN_FN vec2 gn_pcss_shift(GnLookup at, GnPcssLight half_light, vec2 q, float spread) {
    vec3 point_ws = q.x * half_light.right_ws + q.y * half_light.up_ws;
    vec3 way_ws = spread * point_ws;
    float fall = gn_bent(at.view) ? 0.0f : dot(gn_row(at.view.cs_from_ws, 3), way_ws) / gn_clip(at.view, at.receiver.p_ws).w;
    vec2 shift_ts = vec2(dot(at.projected.du_ws, way_ws), dot(at.projected.dv_ws, way_ws)) / max(1.0f + fall, 0.1f);
    return GN_VIEW_KIND >= 3 ? vec2(shift_ts.x, gn_log_unstep(shift_ts.y, at.projected.rows)) : shift_ts;
}

// Half the sides of the rectangle of the map around all such points.
GN_FN vec2 gn_pcss_reach(GnLookup at, GnPcssLight half_light, float spread) {
    vec2 right_ts = abs(gn_pcss_shift(at, half_light, vec2(1.0f, 0.0f), spread));
    vec2 up_ts = abs(gn_pcss_shift(at, half_light, vec2(0.0f, 1.0f), spread));
    return half_light.square ? right_ts + up_ts : sqrt(right_ts * right_ts + up_ts * up_ts);
}

// What lengthens a kernel beyond the light's points: by so much along the ways of its two axes on the map.
struct GnPcssWiden {
    vec2 right_ts;
    vec2 up_ts;
};

// Both axes lengthened, by `more_ts` in any case and besides to at least `least_ts`.
GN_FN GnPcssWiden gn_pcss_widen(GnLookup at, GnPcssLight half_light, float spread, float more_ts, float least_ts) {
    vec2 right_ts = gn_pcss_shift(at, half_light, vec2(1.0f, 0.0f), spread);
    vec2 up_ts = gn_pcss_shift(at, half_light, vec2(0.0f, 1.0f), spread);
    float right = length(right_ts);
    float up = length(up_ts);
    GnPcssWiden widen;
    widen.right_ts = (right > 0.0f ? right_ts / right : vec2(1.0f, 0.0f)) * (more_ts + max(least_ts - right, 0.0f));
    widen.up_ts = (up > 0.0f ? up_ts / up : vec2(0.0f, 1.0f)) * (more_ts + max(least_ts - up, 0.0f));
    return widen;
}

// Point i of n in the light's own shape, turned or moved by the pixel's noise.
GN_FN vec2 gn_pcss_point(bool square, int i, int n, float noise) {
    if (square) {
        vec2 cell = vec2(0.75487767f, 0.56984029f) * float(i) + vec2(noise, fract(7.0f * noise + 0.5f));
        return 2.0f * fract(cell) - 1.0f;
    }
    return gn_vogel(i, n, 6.28318531f * noise);
}

// What of the light's extent is between receiver and blockers.
GN_FN float gn_pcss_spread_at(GnLookup at, float receiver, float blocker) {
    float spread = gn_pcss_spread(at.view.eye_ws.w <= 0.5f, receiver, blocker);
    return at.light.kind == uint(GN_LIGHT_POINT) ? spread * gn_pcss_bulge(at.light.radius, blocker) : spread;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// What the rectangle around the light's points holds through a plane at `spread`: the least depth, and whether all of it or
// none of it hides the receiver's plane (1, 0), else -1.
vec2 gn_pcss_extremes(GnLookup at, sampler2DArray pyramid, vec2 reach_ts) {
    vec2 low_ts = at.projected.uv_ts - reach_ts;
    vec2 high_ts = at.projected.uv_ts + reach_ts;
    vec2 first_ts = max(low_ts, at.projected.bounds_ts.xy);
    vec2 last_ts = min(high_ts, at.projected.bounds_ts.zw - 0.5 * at.projected.texel_ts);
    ivec2 first = ivec2(floor(first_ts / at.projected.texel_ts));
    ivec2 last = max(ivec2(floor(last_ts / at.projected.texel_ts)), first);
    int level = gn_pyramid_first(int(1.0 / at.projected.texel_ts + 0.5), textureSize(pyramid, 0).x);
    vec2 found = gn_pyramid_min_max(pyramid, first >> level, last >> level, at.projected.layer, textureQueryLevels(pyramid));
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

// Metres along the axis to what a tap holds: where tap_ts lies on the receiver's map, uv_ts on that of the tap's own view, and
// there the receiver's plane at the depth `plane`. Where kernels cross views:
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view
float gn_pcss_seen(GnLookup at, GnLookup tap, vec3 axis, vec2 tap_ts, vec2 uv_ts, float plane, float depth) {
#ifdef GN_CROSSING
    // Parallel views begin at different depths: as much nearer than the receiver's plane in its own view as in the tap's.
    if (tap.view.eye_ws.w <= 0.5) {
        float here = gn_pcss_distance(at.view, axis, tap_ts, gn_depth_at(at.projected, tap_ts, at.bias));
        return here - (plane - depth) * tap.projected.metres_per_depth;
    }
#endif
    return gn_pcss_distance(tap.view, axis, uv_ts, depth);
}

// Where what hides the light from a receiver can lie.
struct GnPcssRegion {
    float visibility;  // 0 or 1 where the extremes decide, else -1
    float receiver;    // metres along the axis
    float nearest;     // likewise, of the nearest that the region holds
    float spread;      // of a blocker there
};

// From the nearest that the whole view holds, then from the nearest in the region that follows from it. `least`: texels by
// which kernels reach farther than the light's points.
GnPcssRegion gn_pcss_region(GnLookup at, sampler2DArray pyramid, GnPcssLight half_light, vec3 axis, float least, bool early_out) {
    GnPcssRegion region;
    region.visibility = -1.0;
    region.receiver = gn_pcss_distance(at.view, axis, at.projected.uv_ts, at.projected.depth);
    vec2 least_ts = vec2(least * at.projected.texel_ts);
    vec2 found = gn_pcss_extremes(at, pyramid, at.projected.bounds_ts.zw - at.projected.bounds_ts.xy);
    for (int step = 0; step < 3; ++step) {
        region.nearest = gn_pcss_distance(at.view, axis, at.projected.uv_ts, max(found.x, 0.0));
        region.spread = gn_pcss_spread_at(at, region.receiver, region.nearest);
        found = gn_pcss_extremes(at, pyramid, gn_pcss_reach(at, half_light, region.spread) + least_ts);
        if (found.y >= 0.0 && early_out) {
            region.visibility = found.y;
            return region;
        }
    }
    return region;
}
#endif

#endif
