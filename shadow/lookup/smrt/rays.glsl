// SPDX-License-Identifier: MIT
// Rays marched through a map: from the receiver to points of the light, each hidden where it passes through a surface that the map
// holds. Compiles as GLSL and as C++ (the tests check its laws on the CPU).
// Based on: Agrawala, Ramamoorthi, Heirich, Moll. Efficient Image-Based Methods for Rendering Soft Shadows. SIGGRAPH 2000. [ARHM00]
// Departs from it: one map from the light's centre instead of layered images from several points, so that what a ray meets behind
// the first surface is guessed from where surfaces end; heights are measured over the receiver's plane, along the centre's rays.
#ifndef GN_SHADOW_LOOKUP_SMRT_RAYS_GLSL
#define GN_SHADOW_LOOKUP_SMRT_RAYS_GLSL

#include "shadow/lookup/smrt/smrt.h"
#include "shadow/receiver/light_extent.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Heights are told along the rays from the light's centre: metres of a sun, else shares of the way from the receiver's plane to
// the light, which are the same in every view around it. Where a ray to point x of the light is when the receiver's plane would
// be seen moved by `spread` x (gn_extent_way); the plane falls away below it 1 - rise times as fast as it climbs.
GN_FN float gn_smrt_lift(bool far, float spread, float rise) { return far ? spread * rise : spread * rise / (1.0f + spread); }

// The inverse: where the ray is as high as that.
GN_FN float gn_smrt_spread(bool far, float height, float rise) {
    return far ? height / rise : height / max(rise - height, 1.0e-6f * rise);
}

// What point x of the light adds to a ray's climb over a plane: rise = 1 + dot(per_ws, x).
GN_FN vec3 gn_smrt_per(GnLight light, vec3 p_ws, vec3 n_ws) {
    bool far = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    vec3 to_centre_ws = far ? -vec3(light.direction_ws) : vec3(light.position_ws) - p_ws;
    float climb = dot(n_ws, to_centre_ws);
    return n_ws / max(climb, 1.0e-4f * length(to_centre_ws));
}

// The light's half axes; a sphere is seen as the disc through its centre that fills the cone of its rays.
GN_FN GnExtentLight gn_smrt_light(GnLight light, vec3 p_ws) {
    GnExtentLight half_light = gn_extent_light(light, p_ws);
    if (light.kind == uint(GN_LIGHT_POINT)) {
        float wider = gn_extent_bulge(light.radius, length(vec3(light.position_ws) - p_ws));
        half_light.right_ws = half_light.right_ws * wider;
        half_light.up_ws = half_light.up_ws * wider;
    }
    return half_light;
}

// Step i of n, 1 to n, as a share of a ray: evenly, moved by `jitter` in (0,1]; the last is its end.
GN_FN float gn_smrt_step(int i, int n, float jitter) { return (float(i) - 1.0f + jitter) / (float(n) - 1.0f + jitter); }

// Two neighbouring samples of the map, and where the ray is over the receiver's plane at each.
struct GnSmrtPiece {
    float lift_from;
    float lift_to;
    float height_from;
    float height_to;
};

// Whether the ray passes through the surface that both samples lie on.
GN_FN bool gn_smrt_passes(GnSmrtPiece piece) {
    return (piece.lift_from < piece.height_from) != (piece.lift_to < piece.height_to);
}

// Whether it passes the height of one of two surfaces between the samples, if that goes on from its sample.
GN_FN bool gn_smrt_passes_level(GnSmrtPiece piece, float level) { return piece.lift_from < level && piece.lift_to >= level; }

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// What all rays of a receiver share.
struct GnSmrtFan {
    GnExtentLight half_light;
    GnExtentKernel one;  // of a spread of 1
    vec3 per_ws;
    bool far;
    float spread;    // where rays end: before the nearest that any of them can meet
    float least_ts;  // half width of the narrowest fan
    vec2 reach;      // of the light's two axes, in uv for each unit of spread
    vec2 right_way;  // their ways over the map, unit
    vec2 up_way;
    float steepest;  // the height that a surface changes by from texel to texel at most
};

GnSmrtFan gn_smrt_fan(GnLookup at, GnExtentLight half_light, float spread, GnSmrtParams params) {
    GnSmrtFan fan;
    fan.half_light = half_light;
    fan.one = gn_extent_kernel(at, half_light, 1.0);
    fan.far = at.view.eye_ws.w <= 0.5;
    GnBias bias = at.bias;
    vec3 n_ws = GN_BIAS_PLANE ? at.receiver.n_ws : gn_to_light(at.light, at.receiver.p_ws);
    fan.per_ws = gn_smrt_per(at.light, at.receiver.p_ws, n_ws);
    fan.spread = spread;
    fan.least_ts = params.least * at.projected.texel_ts;
    vec4 axes_ts = gn_extent_axes(gn_extent_spread_by(fan.one, spread));
    vec2 right_ts = axes_ts.xy;
    vec2 up_ts = axes_ts.zw;
    float right = length(right_ts);
    float up = length(up_ts);
    fan.reach = spread > 0.0 ? vec2(right, up) / spread : vec2(0.0);
    fan.right_way = right > 0.0 ? right_ts / right : vec2(1.0, 0.0);
    fan.up_way = up > 0.0 ? up_ts / up : vec2(0.0, 1.0);
    float width = fan.far ? at.projected.texel_ws : at.projected.texel_ws / length(at.view.eye_ws.xyz - at.receiver.p_ws);
    fan.steepest = params.steepest * width;
    return fan;
}

// Where a ray to point q of the light is on the map, from the receiver's own place; never nearer to it than the least fan.
vec2 gn_smrt_way(GnSmrtFan fan, vec2 q, float spread) {
    vec2 least = max(vec2(fan.least_ts) - spread * fan.reach, vec2(0.0));
    return gn_extent_way(gn_extent_spread_by(fan.one, spread), q) + q.x * least.x * fan.right_way + q.y * least.y * fan.up_way;
}

// Where kernels cross views (shadow/receiver/map_access.glsl), rays go on in the view that serves them.
//   #define GN_CROSSING
//   with #define GN_CHOICE(receiver) GnChoice(0, -1, 0.0)
//   with #define GN_LIGHT_VIEW(i) at.view

// How high over the receiver's plane what a texel holds lies, where it was sampled: at its centre.
float gn_smrt_height(GnLookup at, sampler2DArray depth, vec2 tap_ts) {
    vec2 uv_ts;
    GnLookup tap = gn_tap_reader(at, tap_ts, uv_ts);
    vec2 last_ts = tap.projected.bounds_ts.zw - 0.5 * tap.projected.texel_ts;
    ivec2 texel = ivec2(floor(clamp(uv_ts, tap.projected.bounds_ts.xy, last_ts) / tap.projected.texel_ts));
    float plane = gn_depth_at(tap.projected, (vec2(texel) + 0.5) * tap.projected.texel_ts, tap.bias);
    float above = plane - gn_map_texel(depth, tap, texel).r;
    if (tap.view.eye_ws.w <= 0.5) {
        return above * tap.projected.metres_per_depth;
    }
    float eye = gn_bent(tap.view) ? 0.0 : dot(tap.view.depth_from_ws, vec4(tap.view.eye_ws.xyz, 1.0));
    return above / max(plane - eye, 1.0e-6 * (1.0 - eye));
}

// Whether a surface that ends between two samples is still there where the ray would pass through it. What lies beneath another is
// taken for there, or for open.
bool gn_smrt_meets(GnLookup at, sampler2DArray depth, GnSmrtFan fan, vec2 q, float rise, float level, float room, bool extended) {
    vec2 way_ts = gn_smrt_way(fan, q, gn_smrt_spread(fan.far, level, rise));
    float height = gn_smrt_height(at, depth, at.projected.uv_ts + way_ts);
    return abs(height - level) <= room || (extended && height > level);
}

// Whether anything hides point q of the light.
bool gn_smrt_hidden(GnLookup at, sampler2DArray depth, GnSmrtFan fan, vec2 q, float jitter, GnSmrtParams params) {
    float rise = 1.0 + dot(fan.per_ws, q.x * fan.half_light.right_ws + q.y * fan.half_light.up_ws);
    if (rise <= 1.0e-4) {
        return true;  // the receiver's own plane does
    }
    bool extended = params.gaps == GN_SMRT_EXTENDED;
    vec2 before_ts = gn_smrt_way(fan, q, 0.0);
    float texels = length(gn_smrt_way(fan, q, fan.spread) - before_ts) / at.projected.texel_ts;
    int steps = clamp(int(ceil(texels)), 1, params.steps);
    GnSmrtPiece piece;
    piece.lift_to = 0.0;
    piece.height_to = gn_smrt_height(at, depth, at.projected.uv_ts + before_ts);
    float beneath = -1.0;  // height of a surface over the ray that goes on beneath a nearer one; -1: none
    for (int i = 1; i <= steps; ++i) {
        float spread = fan.spread * gn_smrt_step(i, steps, jitter);
        vec2 way_ts = gn_smrt_way(fan, q, spread);
        piece.lift_from = piece.lift_to;
        piece.height_from = piece.height_to;
        piece.lift_to = gn_smrt_lift(fan.far, spread, rise);
        piece.height_to = gn_smrt_height(at, depth, at.projected.uv_ts + way_ts);
        float room = fan.steepest * max(length(way_ts - before_ts) / at.projected.texel_ts, 1.0);
        before_ts = way_ts;
        if (abs(piece.height_to - piece.height_from) <= room) {
            if (gn_smrt_passes(piece)) {
                return true;
            }
        } else {
            // A surface ends between the samples, and another begins.
            if (gn_smrt_passes_level(piece, piece.height_from) &&
                gn_smrt_meets(at, depth, fan, q, rise, piece.height_from, room, extended)) {
                return true;
            }
            if (gn_smrt_passes_level(piece, piece.height_to) &&
                gn_smrt_meets(at, depth, fan, q, rise, piece.height_to, room, extended)) {
                return true;
            }
            if (extended && piece.height_to > piece.height_from && piece.lift_to < piece.height_from) {
                beneath = beneath < 0.0 ? piece.height_from : min(beneath, piece.height_from);
            }
        }
        // What goes on beneath ends where it is seen again, or what lies beyond it.
        beneath = piece.height_to <= beneath + room ? -1.0 : beneath;
        if (beneath >= 0.0 && piece.lift_to >= beneath) {
            return true;
        }
    }
    // Nothing lies beyond the ray's end: what still hides it there does.
    return piece.lift_to < piece.height_to;
}

// The share of the light that rays reach, of a receiver that nothing hides beyond the way that points of the light are seen moved by
// at `spread`. `noise` in [0,1) turns them.
float gn_smrt_share(GnLookup at, sampler2DArray depth, GnExtentLight half_light, float spread, GnSmrtParams params, float noise) {
    GnSmrtFan fan = gn_smrt_fan(at, half_light, spread, params);
    bool one = params.least == 0.0 && half_light.right_ws == vec3(0.0) && half_light.up_ws == vec3(0.0);
    int rays = one ? 1 : params.rays;
    GnExtentPoints points = gn_extent_points(half_light.square, rays, noise);
    float lit = 0.0;
    for (int i = 0; i < rays; ++i) {
        vec2 q = gn_extent_next(points);
        float jitter = 1.0 - fract(noise + 0.61803399 * float(i));
        lit += gn_smrt_hidden(at, depth, fan, q, jitter, params) ? 0.0 : 1.0;
    }
    return lit / float(rays);
}
#endif

#endif
