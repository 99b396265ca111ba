// SPDX-License-Identifier: MIT
// What a lookup is given: the receiver, and the receiver seen in one light view with the bias applied.
// Compiles as GLSL and as C++ (the tests check its laws on the CPU).
//
// Space suffixes: _ws world, _cs the light's clip space, _ts texture space of the map's layer ([0,1]^2), _ss pixels.
// Based on: Isidoro. Shadow Mapping: GPU-based Tips and Techniques. GDC 2006. [Isi06]
// Departs from it: the plane's depth is exact under any projection, not a constant gradient.
// The cone and the view bias: Akenine-Moeller, Haines, Hoffman, Pesce, Iwanicki, Hillaire. Real-Time Rendering. 2018.
// [AHH18], 7.4 and 7.5.
#ifndef GN_SHADOW_RECEIVER_GLSL
#define GN_SHADOW_RECEIVER_GLSL

#include "base/shared.h"
#include "shadow/receiver/parallel_views.glsl"
#include "shadow/receiver/bias.h"
#include "shadow/light_view.h"
#include "shadow/receiver/logarithm.glsl"
#include "shadow/receiver/paraboloid.glsl"
#include "shadow/scene/light.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What a host may fix when it compiles: whether there is a cone, whether taps follow the receiver's plane, and the kind of
// all views of the placement, 0 affine, 1 perspective or affine, 2 paraboloids, 3 logarithmic or perspective. Left open, all of it
// is decided tap by tap.
//   #define GN_BIAS_CONE 0
//   #define GN_BIAS_PLANE true
//   #define GN_VIEW_KIND 0
#if defined(__cplusplus)
#define GN_BIAS_CONE 1
#define GN_BIAS_PLANE (bias.receiver_plane != 0)
#define GN_VIEW_KIND 4
#endif
#ifndef GN_BIAS_CONE
#define GN_BIAS_CONE 1
#endif
#ifndef GN_BIAS_PLANE
#define GN_BIAS_PLANE (bias.receiver_plane != 0)
#endif
#ifndef GN_VIEW_KIND
#define GN_VIEW_KIND 4
#endif

// A view sample as every stage sees it.
struct GnReceiver {
    vec3 p_ws;
    vec3 n_ws;         // geometric normal, towards the camera, unit
    float view_depth;  // metres along the camera's axis
    vec2 p_ss;         // pixel centre, in pixels
    vec3 ddx_ws;       // the receiver's change from one pixel to the next, along its plane: to the right
    vec3 ddy_ws;       // and downwards; metres
    vec3 to_camera_ws;  // unit
    int object;         // index into the scene's objects; only where casters = ids
};

// The receiver in one light view, moved by the bias.
struct GnProjected {
    vec2 uv_ts;             // in the layer
    float depth;            // linear depth in [0,1], moved towards the light by the bias
    float bias;             // what the bias took off it
    int layer;
    vec2 plane_slope;       // depth of the receiver's plane at uv + d: depth + dot(slope, d) / (1 - dot(fall, d))
    vec2 plane_fall;
    vec2 plane_curve;       // of a paraboloid: slope and fall each gain dot(d, d) times this; else 0
    float rows;             // of a logarithmic view: its rate over v, by which d.y counts as gn_log_step says; else 0
    vec3 du_ws;             // gradient of uv_ts over the world, per metre
    vec3 dv_ws;
    float texel_ts;         // 1 / resolution
    float texel_ws;         // side of a texel at the receiver, across the rays, metres (the larger of both axes)
    vec4 bounds_ts;         // min.xy, max.zw of the view's rectangle
    float metres_per_depth;
    float cone;             // depth towards the light per unit of uv between a tap and the receiver
    float cone_share;       // likewise, as a share of what the plane falls away from the light by
    bool inside;            // false: the view does not see the receiver
};

// What a lookup is given of one receiver in one light view.
struct GnLookup {
    GnReceiver receiver;
    GnProjected projected;
    GnBias bias;
    GnLight light;
    GnLightView view;
};

// A choice of views for a receiver: V = mix(V(first), V(second), weight); second is -1 where one view suffices.
struct GnChoice {
    int first;
    int second;
    float weight;
};

// What the choice function of a placement is given that has nothing to tell it; others have a type of their own.
struct GnPlacementData {
    vec4 nothing;
};

// Smallest depth difference that is not rounding: the rasterizer interpolates a 24-bit significand.
const float gn_depth_epsilon = 4.0f / 16777216.0f;

// Beyond it a plane seen edge-on would give depths behind the eye.
const float gn_least_divisor = 1.0e-3f;

// Whether the view is a paraboloid: straight lines are bent on its map.
GN_FN bool gn_bent(GnLightView view) {
    return GN_VIEW_KIND == 2 || (GN_VIEW_KIND == 4 && view.paraboloid > 0.0f);
}

// The rate of a logarithmic view's rows; 0 of every other.
GN_FN float gn_log_rate(GnLightView view) { return GN_VIEW_KIND >= 3 ? max(-view.paraboloid, 0.0f) : 0.0f; }

// Where a point of clip space lies on a view's map, from -1 to 1; and where it lies on the layer.
GN_FN vec2 gn_place(GnLightView view, vec4 p_cs) {
    if (gn_bent(view)) {
        return gn_paraboloid(vec3(p_cs)) / view.paraboloid;
    }
    return gn_log_place(vec3(p_cs.x, p_cs.y, GN_VIEW_KIND == 0 ? 1.0f : p_cs.w), gn_log_rate(view));
}
GN_FN vec2 gn_layer_place(GnLightView view, vec2 place) {
    return vec2(view.rect_ts.x, view.rect_ts.y) + (place * 0.5f + 0.5f) * vec2(view.rect_ts.z, view.rect_ts.w);
}
// What x / w and y / w are where a ray falls on the layer; of a paraboloid the coordinates on its disc over its extent.
GN_FN vec2 gn_ndc_at(GnLightView view, vec2 uv_ts) {
    vec2 place = (uv_ts - vec2(view.rect_ts.x, view.rect_ts.y)) / vec2(view.rect_ts.z, view.rect_ts.w) * 2.0f - 1.0f;
    return gn_log_ndc(place, gn_log_rate(view));
}

// Unit direction from p_ws to the view's eye.
GN_FN vec3 gn_to_eye(GnLightView view, vec3 p_ws) {
    return view.eye_ws.w > 0.5f ? normalize(vec3(view.eye_ws) - p_ws) : vec3(view.eye_ws);
}

GN_FN vec3 gn_row(mat4 m, int i) { return vec3(m[0][i], m[1][i], m[2][i]); }

// Gradients of uv_ts over the world under a paraboloid.
GN_FN void gn_paraboloid_gradients(GnLightView view, vec3 p_ls, vec2 scale_ts, GN_OUT(vec3) du_ws, GN_OUT(vec3) dv_ws) {
    float size = length(p_ls);
    vec2 u = gn_paraboloid(p_ls);
    vec3 pull = p_ls / size + vec3(0.0f, 0.0f, 1.0f);
    vec3 gu = (vec3(1.0f, 0.0f, 0.0f) - u.x * pull) / (size + p_ls.z) * (scale_ts.x / view.paraboloid);
    vec3 gv = (vec3(0.0f, 1.0f, 0.0f) - u.y * pull) / (size + p_ls.z) * (scale_ts.y / view.paraboloid);
    vec3 x = gn_row(view.cs_from_ws, 0);
    vec3 y = gn_row(view.cs_from_ws, 1);
    vec3 z = gn_row(view.cs_from_ws, 2);
    du_ws = gu.x * x + gu.y * y + gu.z * z;
    dv_ws = gv.x * x + gv.y * y + gv.z * z;
}

// Gradients of uv_ts over the world at p_ws, per metre.
GN_FN void gn_uv_gradients(GnLightView view, vec3 p_ws, GN_OUT(vec3) du_ws, GN_OUT(vec3) dv_ws) {
    vec2 scale_ts = 0.5f * vec2(view.rect_ts.z, view.rect_ts.w);
    vec3 row_w = gn_row(view.cs_from_ws, 3);
    vec4 p_cs = gn_clip(view, p_ws);
    float inverse_w = GN_VIEW_KIND == 0 ? 1.0f : 1.0f / p_cs.w;
    du_ws = (gn_row(view.cs_from_ws, 0) - p_cs.x * inverse_w * row_w) * (inverse_w * scale_ts.x);
    dv_ws = (gn_row(view.cs_from_ws, 1) - p_cs.y * inverse_w * row_w) * (inverse_w * scale_ts.y);
    if (gn_bent(view)) {
        gn_paraboloid_gradients(view, vec3(p_cs), scale_ts, du_ws, dv_ws);
    }
    float rate = gn_log_rate(view);
    if (rate > 0.0f) {
        dv_ws = (row_w * inverse_w - gn_row(view.cs_from_ws, 1) / p_cs.y) * (view.rect_ts.w / rate);
    }
}

// Linear depth that one metre towards the view's eye takes off.
GN_FN float gn_depth_per_metre(GnLightView view, vec3 to_eye_ws) {
    return gn_bent(view) ? 1.0f / view.metres_per_depth : -dot(vec3(view.depth_from_ws), to_eye_ws);
}

// Half a pixel's reach across the rays of light, in metres, where a kernel covers the pixel's footprint.
GN_FN float gn_pixel_reach(GnReceiver receiver, vec3 to_eye_ws, GnBias bias) {
    if (bias.reach_pixels <= 0.0f) {
        return 0.0f;
    }
    return 0.5f * bias.reach_pixels *
           (length(cross(receiver.ddx_ws, to_eye_ws)) + length(cross(receiver.ddy_ws, to_eye_ws)));
}

// Factor of the biases in texels: they cover half a texel to each side, a kernel reaches further, by `more_ws` metres where
// it covers pixels. Following the receiver's plane leaves nothing of that to cover.
GN_FN float gn_bias_growth(GnBias bias, float texel_ws, float more_ws) {
    float reach = max(bias.reach, bias.reach_world / texel_ws) + more_ws / texel_ws;
    return 1.0f + (bias.receiver_plane == 0 ? 2.0f * bias.kernel * reach : 0.0f);
}

// Where a receiver is looked up: moved towards the light, along its normal where the light grazes it, and towards the
// camera. All moves are measured in texels at the receiver.
GN_FN vec3 gn_biased(GnReceiver receiver, vec3 to_eye_ws, float texel_ws, GnBias bias) {
    float cosine = clamp(dot(receiver.n_ws, to_eye_ws), 0.0f, 1.0f);
    float sine = sqrt(max(0.0f, 1.0f - cosine * cosine));
    float tangent = cosine * bias.slope_max > sine ? sine / cosine : bias.slope_max;
    float texels_ws = gn_bias_growth(bias, texel_ws, gn_pixel_reach(receiver, to_eye_ws, bias)) * texel_ws;
    float towards_light = (bias.constant + bias.slope * tangent) * texels_ws + bias.constant_world;
    float along_normal = (bias.normal * texels_ws + bias.normal_world) * sine;
    float towards_camera = bias.view * texels_ws + bias.view_world;
    return receiver.p_ws + to_eye_ws * towards_light + receiver.n_ws * along_normal +
           receiver.to_camera_ws * towards_camera;
}

// Projects the moved receiver on a paraboloid and sets up the depth of its plane m: along the ray of u it is
// (1 + |u|^2) / (2 m.xy u + m.z (1 - |u|^2)), a quotient of quadratic forms, expanded around the receiver's u.
GN_FN GnProjected gn_project_paraboloid(GnProjected result, GnLightView view, vec3 p_ls, vec3 n_ws) {
    vec2 u = gn_paraboloid(p_ls);
    vec2 extent_ts = vec2(view.rect_ts.z, view.rect_ts.w);
    result.uv_ts = vec2(view.rect_ts.x, view.rect_ts.y) + (u / view.paraboloid * 0.5f + 0.5f) * extent_ts;
    float depth = length(p_ls) / view.metres_per_depth;
    result.depth = depth - gn_depth_epsilon;
    result.bias -= depth;
    result.inside = max(abs(u.x), abs(u.y)) <= view.paraboloid;
    result.plane_slope = vec2(0.0f);
    result.plane_fall = vec2(0.0f);
    result.plane_curve = vec2(0.0f);

    vec3 n = vec3(dot(gn_row(view.cs_from_ws, 0), n_ws), dot(gn_row(view.cs_from_ws, 1), n_ws),
                  dot(gn_row(view.cs_from_ws, 2), n_ws));
    float height = dot(n, p_ls) / view.metres_per_depth;
    if (abs(height) > 1.0e-4f * depth) {
        vec3 m = n / height;
        vec2 per_ts = 2.0f * view.paraboloid / extent_ts;
        float divisor = (1.0f + dot(u, u)) / depth;
        vec2 gradient = 2.0f * (vec2(m.x, m.y) - m.z * u);
        result.plane_slope = (2.0f * u - depth * gradient) * per_ts / divisor;
        result.plane_fall = -gradient * per_ts / divisor;
        result.plane_curve = vec2(1.0f + depth * m.z, m.z) * (per_ts.x * per_ts.x / divisor);
    }
    return result;
}

// The cone of a steepness, in depth per unit of uv, for a plane whose depth has a slope of 1 where it is `unit`. Creases
// that are lit on both sides lie where the receiver's plane falls away from the light, and what casts contact shadows on
// it where it rises: so a cone that goes with the plane opens to one side only, fully from a tangent of 1/4.
GN_FN GnProjected gn_open_cone(GnProjected projected, float steepness, float unit, GnBias bias) {
    float slope = max(length(projected.plane_slope), 0.25f * unit);
    projected.cone = bias.receiver_plane == 0 ? steepness * unit : 0.0f;
    projected.cone_share = bias.receiver_plane == 0 ? 0.0f : steepness * unit / slope;
    return projected;
}

// Map texels and bias are measured where the receiver is; then the receiver is moved and projected.
GN_FN GnProjected gn_project(GnReceiver receiver, GnLightView view, GnBias bias) {
    GnProjected result;
    vec2 scale_ts = 0.5f * vec2(view.rect_ts.z, view.rect_ts.w);
    vec3 row_w = gn_row(view.cs_from_ws, 3);

    // Measure a texel at the receiver, and move the receiver by the bias.
    gn_uv_gradients(view, receiver.p_ws, result.du_ws, result.dv_ws);
    result.texel_ts = 1.0f / view.resolution;
    result.texel_ws = result.texel_ts / min(length(result.du_ws), length(result.dv_ws));
    vec3 to_eye = gn_to_eye(view, receiver.p_ws);
    vec3 p_ws = gn_biased(receiver, to_eye, result.texel_ws, bias);
    float unit = gn_depth_per_metre(view, to_eye) * result.texel_ws * view.resolution;

    // Project.
    result.layer = view.layer;
    result.metres_per_depth = view.metres_per_depth;
    result.bounds_ts = vec4(view.rect_ts.x, view.rect_ts.y, view.rect_ts.x + view.rect_ts.z, view.rect_ts.y + view.rect_ts.w);
    vec4 p_cs = gn_clip(view, p_ws);
    float rate = gn_log_rate(view);
    result.rows = rate / view.rect_ts.w;
    if (gn_bent(view)) {
        result.bias = length(vec3(gn_clip(view, receiver.p_ws))) / view.metres_per_depth;
        return gn_open_cone(gn_project_paraboloid(result, view, vec3(p_cs), receiver.n_ws), bias.cone, unit, bias);
    }
    result.plane_curve = vec2(0.0f);
    float w = GN_VIEW_KIND == 0 ? 1.0f : p_cs.w;
    float inverse_w = 1.0f / w;
    vec2 p_ndc = vec2(p_cs.x, p_cs.y) * inverse_w;
    vec2 place = rate > 0.0f ? gn_place(view, p_cs) : p_ndc;
    result.uv_ts = gn_layer_place(view, place);
    result.depth = dot(view.depth_from_ws, vec4(p_ws, 1.0f)) - gn_depth_epsilon;
    result.bias = -dot(vec3(view.depth_from_ws), p_ws - receiver.p_ws);
    result.inside = w > 0.0f && abs(place.x) <= 1.0f && abs(place.y) <= 1.0f;

    // The receiver's plane: displacements e_u, e_v within it that move uv by one, to first order; the division in
    // gn_plane_depth makes them exact. Solve [gx gy n]^T d = (du, dv, 0) (w + row_w d) for d.
    vec3 gx = (gn_row(view.cs_from_ws, 0) - p_ndc.x * row_w) * scale_ts.x;
    vec3 gy = (gn_row(view.cs_from_ws, 1) - p_ndc.y * row_w) * scale_ts.y;
    if (rate > 0.0f) {
        gy = (row_w - gn_row(view.cs_from_ws, 1) / p_ndc.y) / result.rows;
    }
    float determinant = dot(gx, cross(gy, receiver.n_ws));
    if (abs(determinant) > 1.0e-4f * length(gx) * length(gy)) {
        vec3 e_u = cross(gy, receiver.n_ws) / determinant;
        vec3 e_v = cross(receiver.n_ws, gx) / determinant;
        vec3 depth_axis = vec3(view.depth_from_ws);
        result.plane_slope = vec2(dot(depth_axis, e_u), dot(depth_axis, e_v)) * w;
        result.plane_fall = vec2(dot(row_w, e_u), dot(row_w, e_v));
    } else {
        result.plane_slope = vec2(0.0f);
        result.plane_fall = vec2(0.0f);
    }
    return gn_open_cone(result, bias.cone, unit, bias);
}

// Depth that the cone takes off a tap at a distance from the receiver.
GN_FN float gn_cone(GnProjected projected, vec2 d_ts) {
    if (GN_BIAS_CONE == 0) {
        return 0.0f;
    }
    return projected.cone * length(d_ts) + projected.cone_share * max(dot(projected.plane_slope, d_ts), 0.0f);
}

// Linear depth of the receiver's plane at uv_ts, or of the receiver itself where bias.receiver_plane is off.
GN_FN float gn_depth_at(GnProjected projected, vec2 uv_ts, GnBias bias) {
    vec2 d_ts = uv_ts - projected.uv_ts;
    float depth = projected.depth - gn_cone(projected, d_ts);
    if (!GN_BIAS_PLANE) {
        return depth;
    }
    if (GN_VIEW_KIND >= 3) {
        d_ts.y = gn_log_step(d_ts.y, projected.rows);
    }
    float slope = dot(projected.plane_slope, d_ts);
    if (GN_VIEW_KIND == 0) {
        return depth + slope;
    }
    vec2 curve = GN_VIEW_KIND == 1 || GN_VIEW_KIND == 3 ? vec2(0.0f) : projected.plane_curve * dot(d_ts, d_ts);
    float divisor = max(1.0f - dot(projected.plane_fall, d_ts) - curve.y, gn_least_divisor);
    return depth + (slope + curve.x) / divisor;
}

// Whether four occluders beside the receiver leave its plane lit: gn_depth_at <= occluder without the division.
GN_FN bvec4 gn_lit_beside(GnProjected projected, vec4 du_ts, vec4 dv_ts, vec4 occluder, GnBias bias) {
    vec4 room = occluder - projected.depth;
    if (!GN_BIAS_PLANE) {
        vec4 cone = GN_BIAS_CONE == 0 ? vec4(0.0f) : projected.cone * sqrt(du_ts * du_ts + dv_ts * dv_ts);
        return greaterThanEqual(room + cone, vec4(0.0f));
    }
    if (GN_VIEW_KIND >= 3) {
        dv_ts = vec4(gn_log_step(dv_ts.x, projected.rows), gn_log_step(dv_ts.y, projected.rows),
                     gn_log_step(dv_ts.z, projected.rows), gn_log_step(dv_ts.w, projected.rows));
    }
    vec4 offset = projected.plane_slope.x * du_ts + projected.plane_slope.y * dv_ts;
    if (GN_BIAS_CONE == 1) {
        room = room + projected.cone_share * max(offset, vec4(0.0f));
    }
    if (GN_VIEW_KIND == 0) {
        return lessThanEqual(offset, room);
    }
    vec4 divisor = 1.0f - (projected.plane_fall.x * du_ts + projected.plane_fall.y * dv_ts);
    if (GN_VIEW_KIND != 1 && GN_VIEW_KIND != 3 && (projected.plane_curve.x != 0.0f || projected.plane_curve.y != 0.0f)) {
        vec4 square = du_ts * du_ts + dv_ts * dv_ts;
        divisor = divisor - projected.plane_curve.y * square;
        offset = offset + projected.plane_curve.x * square;
    }
    return lessThanEqual(offset, room * max(divisor, gn_least_divisor));
}

// The same at four points of the map.
GN_FN bvec4 gn_lit_at(GnProjected projected, vec4 u_ts, vec4 v_ts, vec4 occluder, GnBias bias) {
    return gn_lit_beside(projected, u_ts - projected.uv_ts.x, v_ts - projected.uv_ts.y, occluder, bias);
}

// A length across the rays at the receiver, in texels of the map's u axis and v axis.
GN_FN vec2 gn_texels(GnProjected projected, float metres) {
    return vec2(length(projected.du_ws), length(projected.dv_ws)) * (metres / projected.texel_ts);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
