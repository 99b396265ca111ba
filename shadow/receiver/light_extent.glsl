// SPDX-License-Identifier: MIT
// The light as a receiver sees it through the map: how far blockers spread its points, and where what hides it can lie.
// Compiles as GLSL and as C++ (the tests check its laws on the CPU).
// Penumbrae: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09], 5.2.2.
#ifndef GN_SHADOW_RECEIVER_LIGHT_EXTENT_GLSL
#define GN_SHADOW_RECEIVER_LIGHT_EXTENT_GLSL

#include "shadow/receiver/across.glsl"
#include "shadow/receiver/map_access.glsl"
#include "shadow/receiver/region_extremes.glsl"
#include "shadow/receiver/noise.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Half the light as the receiver sees it: a point of it is x right + y up from its centre, x and y in [-1,1], within the
// unit disc unless it is square. Metres; of a sun tangents, metres for each metre that a blocker lies before the receiver.
struct GnExtentLight {
    vec3 right_ws;
    vec3 up_ws;
    bool square;
};

GN_FN GnExtentLight gn_extent_light(GnLight light, vec3 p_ws) {
    GnExtentLight half_light;
    half_light.square = light.kind == uint(GN_LIGHT_RECTANGLE);
    if (half_light.square) {
        half_light.right_ws = vec3(light.right_ws) * light.half_size.x;
        half_light.up_ws = vec3(light.up_ws) * light.half_size.y;
        return half_light;
    }
    vec3 right_ws;
    vec3 up_ws;
    // A spot is a disc across its axis; spheres and suns turn their disc to the receiver.
    gn_across(light.kind == uint(GN_LIGHT_SPOT) ? vec3(light.direction_ws) : gn_to_light(light, p_ws), right_ws, up_ws);
    float radius = light.kind == uint(GN_LIGHT_DIRECTIONAL) ? tan(light.angular_radius) : light.radius;
    half_light.right_ws = right_ws * radius;
    half_light.up_ws = up_ws * radius;
    return half_light;
}

// Where distances are measured along, unit, away from the light: across the disc or rectangle that stands for it.
GN_FN vec3 gn_extent_axis(GnLight light, vec3 p_ws) {
    bool flat_light = light.kind == uint(GN_LIGHT_RECTANGLE) || light.kind == uint(GN_LIGHT_SPOT);
    return flat_light ? vec3(light.direction_ws) : -gn_to_light(light, p_ws);
}

// What makes metres along an axis of a view's depths, made ready for many places of its map: over the map's plane, at (x, y, 1) in
// the view's own [-1,1]^2, what a ray makes along the axis and what it makes in depth are linear.
struct GnExtentMetres {
    vec3 axis_ws;
    vec3 along;
    vec3 deep;
    float eye;     // the eye's depth
    bool parallel;
};

GN_FN GnExtentMetres gn_extent_metres(GnLightView view, vec3 axis_ws) {
    GnExtentMetres metres;
    metres.axis_ws = axis_ws;
    metres.along = vec3(0.0f);
    metres.deep = vec3(0.0f);
    metres.eye = dot(view.depth_from_ws, vec4(vec3(view.eye_ws), 1.0f));
    metres.parallel = GN_VIEW_KIND == 0 || view.eye_ws.w <= 0.5f || gn_bent(view);
    if (GN_VIEW_KIND != 0) {
        vec4 seen_ws = 0.5f * view.ws_from_cs[2] + view.ws_from_cs[3];
        vec3 x_ws = vec3(view.ws_from_cs[0]) - view.ws_from_cs[0].w * vec3(view.eye_ws);
        vec3 y_ws = vec3(view.ws_from_cs[1]) - view.ws_from_cs[1].w * vec3(view.eye_ws);
        vec3 middle_ws = vec3(seen_ws) - seen_ws.w * vec3(view.eye_ws);
        vec3 deep_ws = vec3(view.depth_from_ws);
        metres.along = vec3(dot(axis_ws, x_ws), dot(axis_ws, y_ws), dot(axis_ws, middle_ws));
        metres.deep = vec3(dot(deep_ws, x_ws), dot(deep_ws, y_ws), dot(deep_ws, middle_ws));
    }
    return metres;
}
// Of a receiver's own view, along its axis.
GN_FN GnExtentMetres gn_extent_metres_of(GnLookup at) { return gn_extent_metres(at.view, gn_extent_axis(at.light, at.receiver.p_ws)); }

// Metres along the axis from the light to what a tap holds at a linear depth; of a sun from the view's near plane.
GN_FN float gn_extent_distance(GnExtentMetres metres, GnLightView view, vec2 uv_ts, float depth) {
    if (metres.parallel) {
        return depth * view.metres_per_depth;
    }
    vec3 p = vec3(gn_ndc_at(view, uv_ts), 1.0f);
    return dot(metres.along, p) * (depth - metres.eye) / dot(metres.deep, p);
}

// What a receiver at `receiver` metres sees of the light's extent moves by over the receiver, for a blocker at `blocker`
// metres: w_p / w_l = (d_r - d_o) / d_o, of a sun the distance between them. [EASW09] 5.2.2
GN_FN float gn_extent_spread(bool far, float receiver, float blocker) {
    float between = max(receiver - blocker, 0.0f);
    return far ? between : between / max(blocker, 1.0e-3f * receiver);
}

// How much wider than a sphere the disc through its centre is that gives the same penumbra for a blocker at `blocker` metres
// from the centre: it of a sphere is 2 r (d_r - d_o) / sqrt(d_o^2 - r^2) wide.
GN_FN float gn_extent_bulge(float radius, float blocker) {
    float share = min(radius / max(blocker, 1.0e-6f), 0.95f);
    return 1.0f / sqrt(1.0f - share * share);
}

// Metres across the penumbra of what spreads the light's points so, where it lies across the axis.
GN_FN float gn_extent_width(GnExtentLight half_light, float spread) {
    return 2.0f * max(length(half_light.right_ws), length(half_light.up_ws)) * spread;
}

// Where on the map the receiver sees the light's points through a plane across the axis: seen from the light's centre each is where
// the receiver would be if it moved by `spread` times the point. Ways of the points (1, 0) and (0, 1) from the receiver's own
// place, and what the view's perspective divides them by.
struct GnExtentKernel {
    vec2 right_ts;
    vec2 up_ts;
    vec2 fall;
    float rows;  // of a logarithmic view, as the projection's; else 0
};

GN_FN GnExtentKernel gn_extent_kernel(GnLookup at, GnExtentLight half_light, float spread) {
    vec3 right_ws = spread * half_light.right_ws;
    vec3 up_ws = spread * half_light.up_ws;
    GnExtentKernel kernel;
    kernel.right_ts = vec2(dot(at.projected.du_ws, right_ws), dot(at.projected.dv_ws, right_ws));
    kernel.up_ts = vec2(dot(at.projected.du_ws, up_ws), dot(at.projected.dv_ws, up_ws));
    kernel.fall = vec2(0.0f);
    kernel.rows = at.projected.rows;
    if (GN_VIEW_KIND != 0 && !gn_bent(at.view)) {
        vec3 row_w = gn_row(at.view.cs_from_ws, 3);
        kernel.fall = vec2(dot(row_w, right_ws), dot(row_w, up_ws)) / gn_clip(at.view, at.receiver.p_ws).w;
    }
    return kernel;
}

// The same for another spread, of that for a spread of 1.
GN_FN GnExtentKernel gn_extent_spread_by(GnExtentKernel one, float spread) {
    GnExtentKernel kernel = one;
    kernel.right_ts *= spread;
    kernel.up_ts *= spread;
    kernel.fall *= spread;
    return kernel;
}

// The way of point q.
GN_FN vec2 gn_extent_way(GnExtentKernel kernel, vec2 q) {
    vec2 way_ts = q.x * kernel.right_ts + q.y * kernel.up_ts;
    if (GN_VIEW_KIND != 0) {
        way_ts /= max(1.0f + dot(kernel.fall, q), 0.1f);
    }
    return GN_VIEW_KIND >= 3 ? vec2(way_ts.x, gn_log_unstep(way_ts.y, kernel.rows)) : way_ts;
}

// The ways of the points (1, 0) and (0, 1).
GN_FN vec4 gn_extent_axes(GnExtentKernel kernel) {
    return vec4(gn_extent_way(kernel, vec2(1.0f, 0.0f)), gn_extent_way(kernel, vec2(0.0f, 1.0f)));
}

// Half the sides of the rectangle of the map around all such points.
GN_FN vec2 gn_extent_reach(GnExtentKernel kernel, bool square) {
    vec4 axes_ts = abs(gn_extent_axes(kernel));
    vec2 right_ts = vec2(axes_ts.x, axes_ts.y);
    vec2 up_ts = vec2(axes_ts.z, axes_ts.w);
    return square ? right_ts + up_ts : sqrt(right_ts * right_ts + up_ts * up_ts);
}

// What lengthens a kernel beyond the light's points: by so much along the ways of its two axes on the map.
struct GnExtentWiden {
    vec2 right_ts;
    vec2 up_ts;
};

// Both axes lengthened, by `more_ts` in any case and besides to at least `least_ts`.
GN_FN GnExtentWiden gn_extent_widen(GnExtentKernel kernel, float more_ts, float least_ts) {
    vec4 axes_ts = gn_extent_axes(kernel);
    vec2 right_ts = vec2(axes_ts.x, axes_ts.y);
    vec2 up_ts = vec2(axes_ts.z, axes_ts.w);
    float right = length(right_ts);
    float up = length(up_ts);
    GnExtentWiden widen;
    widen.right_ts = (right > 0.0f ? right_ts / right : vec2(1.0f, 0.0f)) * (more_ts + max(least_ts - right, 0.0f));
    widen.up_ts = (up > 0.0f ? up_ts / up : vec2(0.0f, 1.0f)) * (more_ts + max(least_ts - up, 0.0f));
    return widen;
}

// Where point q of a kernel so lengthened is read.
GN_FN vec2 gn_extent_tap_ts(GnLookup at, GnExtentKernel kernel, GnExtentWiden widen, vec2 q) {
    return at.projected.uv_ts + gn_extent_way(kernel, q) + q.x * widen.right_ts + q.y * widen.up_ts;
}

// Points in the light's own shape, one after the other, turned or moved by the pixel's noise: of a disc gn_vogel's, each of which
// is the one before turned by the golden angle, and farther out.
struct GnExtentPoints {
    bool square;
    float count;
    float taken;
    vec2 turn;  // of a square the first point's place
};

GN_FN GnExtentPoints gn_extent_points(bool square, int count, float noise) {
    float angle = 6.28318531f * noise;
    GnExtentPoints points;
    points.square = square;
    points.count = float(count);
    points.taken = 0.0f;
    points.turn = square ? vec2(noise, fract(7.0f * noise + 0.5f)) : vec2(cos(angle), sin(angle));
    return points;
}

GN_FN vec2 gn_extent_next(GN_INOUT(GnExtentPoints) points) {
    vec2 q = 2.0f * fract(vec2(0.75487767f, 0.56984029f) * points.taken + points.turn) - 1.0f;
    if (!points.square) {
        // The cosine and sine of 2.39996323.
        vec2 golden = vec2(-0.73736888f, 0.67549029f);
        q = sqrt((points.taken + 0.5f) / points.count) * points.turn;
        points.turn = vec2(points.turn.x * golden.x - points.turn.y * golden.y, points.turn.x * golden.y + points.turn.y * golden.x);
    }
    points.taken += 1.0f;
    return q;
}

// What of the light's extent is between receiver and blockers.
GN_FN float gn_extent_spread_at(GnLookup at, float receiver, float blocker) {
    float spread = gn_extent_spread(at.view.eye_ws.w <= 0.5f, receiver, blocker);
    return at.light.kind == uint(GN_LIGHT_POINT) ? spread * gn_extent_bulge(at.light.radius, blocker) : spread;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Metres along the axis to what a tap holds: where tap_ts lies on the receiver's map, uv_ts on that of the tap's own view, and
// there the receiver's plane at the depth `plane`. Where kernels cross views:
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view
float gn_extent_seen(GnLookup at, GnLookup tap, GnExtentMetres metres, vec2 tap_ts, vec2 uv_ts, float plane, float depth) {
#ifdef GN_CROSSING
    // Parallel views begin at different depths: as much nearer than the receiver's plane in its own view as in the tap's.
    if (tap.view.eye_ws.w <= 0.5) {
        float here = gn_extent_distance(metres, at.view, tap_ts, gn_depth_at(at.projected, tap_ts, at.bias));
        return here - (plane - depth) * tap.projected.metres_per_depth;
    }
    return gn_extent_distance(gn_extent_metres(tap.view, metres.axis_ws), tap.view, uv_ts, depth);
#else
    return gn_extent_distance(metres, at.view, uv_ts, depth);
#endif
}

// Where views are parts of one map, a region reaches beyond the receiver's; the view that shows all of the map then tells the
// nearest in it, to its own texels, and nothing ends the search early:
//   #define GN_WHOLE_CHOICE(receiver) 0
//   with #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view
#if defined(GN_WHOLE_CHOICE) && defined(GN_CROSSING)
GnLookup gn_extent_whole(GnLookup at) {
    GnLightView view = GN_LIGHT_VIEW(GN_WHOLE_CHOICE(at.receiver));
    return GnLookup(at.receiver, gn_project(at.receiver, view, at.bias), at.bias, at.light, view);
}

// What the receiver's own view holds, and what the whole shows around it through a plane at `spread`, a texel of its farther.
vec2 gn_extent_with_whole(vec2 found, GnLookup whole, sampler2DArray pyramid, GnExtentLight half_light, float spread) {
    vec2 reach_ts = gn_extent_reach(gn_extent_kernel(whole, half_light, spread), half_light.square);
    return vec2(min(found.x, gn_region_extremes(whole, pyramid, reach_ts + whole.projected.texel_ts).x), -1.0);
}
#endif

// Where what hides the light from a receiver can lie.
struct GnExtentRegion {
    float visibility;  // 0 or 1 where the extremes decide, else -1
    float receiver;    // metres along the axis
    float nearest;     // likewise, of the nearest that the region holds
    float spread;      // of a blocker there
};

// With the nearest at a depth of the map.
GnExtentRegion gn_extent_region_to(GnLookup at, GnExtentMetres metres, float receiver, float depth) {
    float nearest = gn_extent_distance(metres, at.view, at.projected.uv_ts, max(depth, 0.0));
    return GnExtentRegion(-1.0, receiver, nearest, gn_extent_spread_at(at, receiver, nearest));
}

// From the nearest that the whole layer holds.
GnExtentRegion gn_extent_anywhere(GnLookup at, sampler2DArray pyramid, GnExtentMetres metres) {
    float receiver = gn_extent_distance(metres, at.view, at.projected.uv_ts, at.projected.depth);
    float nearest = gn_pyramid_all(pyramid, at.projected.layer).x;
#if defined(GN_WHOLE_CHOICE) && defined(GN_CROSSING)
    nearest = min(nearest, gn_pyramid_all(pyramid, gn_extent_whole(at).projected.layer).x);
#endif
    return gn_extent_region_to(at, metres, receiver, nearest);
}

// Half the sides of a region on the map. `least`: texels by which kernels reach farther than the light's points; `one`: a spread of 1.
vec2 gn_extent_region_reach(GnLookup at, GnExtentLight half_light, GnExtentKernel one, GnExtentRegion region, float least) {
    return gn_extent_reach(gn_extent_spread_by(one, region.spread), half_light.square) + least * at.projected.texel_ts;
}

// What a region holds, as gn_region_extremes says it.
vec2 gn_extent_within(GnLookup at, sampler2DArray pyramid, GnExtentLight half_light, GnExtentKernel one, GnExtentRegion region, float least) {
    vec2 found = gn_region_extremes(at, pyramid, gn_extent_region_reach(at, half_light, one, region, least));
#if defined(GN_WHOLE_CHOICE) && defined(GN_CROSSING)
    found = gn_extent_with_whole(found, gn_extent_whole(at), pyramid, half_light, region.spread);
#endif
    return found;
}

// The region that follows from the nearest in another.
GnExtentRegion gn_extent_narrowed(GnLookup at, sampler2DArray pyramid, GnExtentLight half_light, GnExtentKernel one, GnExtentMetres metres,
                              GnExtentRegion region, float least, bool early_out) {
    vec2 found = gn_extent_within(at, pyramid, half_light, one, region, least);
    GnExtentRegion narrow = gn_extent_region_to(at, metres, region.receiver, found.x);
    narrow.visibility = early_out ? found.y : -1.0;
    return narrow;
}

// Whether nothing in the region lies before the receiver's plane.
bool gn_extent_all_before(GnLookup at, sampler2DArray planes, GnExtentLight half_light, GnExtentKernel one, GnExtentRegion region, float least) {
#if defined(GN_WHOLE_CHOICE) && defined(GN_CROSSING)
    return false;
#else
    return gn_region_before(at, planes, gn_extent_region_reach(at, half_light, one, region, least));
#endif
}

// Narrowed twice, and what its extremes decide.
GnExtentRegion gn_extent_region(GnLookup at, sampler2DArray pyramid, GnExtentLight half_light, GnExtentMetres metres, float least,
                            bool early_out) {
    GnExtentKernel one = gn_extent_kernel(at, half_light, 1.0);
    GnExtentRegion region = gn_extent_anywhere(at, pyramid, metres);
    for (int step = 0; step < 2; ++step) {
        region = gn_extent_narrowed(at, pyramid, half_light, one, metres, region, least, early_out);
        if (region.visibility >= 0.0) {
            return region;
        }
    }
    region.visibility = early_out ? gn_extent_within(at, pyramid, half_light, one, region, least).y : -1.0;
    return region;
}
#endif

#endif
