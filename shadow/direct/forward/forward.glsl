// SPDX-License-Identifier: MIT
// The splat of a lit texel: where it lies in the world, and how much of the light it brings to a sample.
// Based on: Zhang. Forward Shadow Mapping. Eurographics Workshop on Rendering 1998. [Zha98]
// Departs from it: a splat's weight is measured in the map's own texels, so that the splats of a lit surface add up to 1.
#ifndef GN_SHADOW_DIRECT_FORWARD_GLSL
#define GN_SHADOW_DIRECT_FORWARD_GLSL

#include "shadow/direct/forward/forward.h"
#include "shadow/light_view.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// A view sample as splats see it. view: the light view that serves it, -1 none does, -2 the light does not count.
struct GnForwardSample {
    vec2 uv_ts;
    float depth;
    float slack;       // how far a splat's depth may be off the sample's plane
    vec2 plane_slope;  // as GnProjected
    vec2 plane_fall;
    float share;       // of the weights around the sample, what texels within its view have
    int view;
};

// The weight of a splat `distance` texels away: a texel's own square for radius 0, else a tent. Tents of a whole radius
// on all texels of a grid add up to one everywhere.
GN_FN float gn_forward_weight(vec2 distance, int radius) {
    if (radius == 0) {
        return distance.x >= -0.5f && distance.x < 0.5f && distance.y >= -0.5f && distance.y < 0.5f ? 1.0f : 0.0f;
    }
    float r = float(radius);
    return max(1.0f - abs(distance.x) / r, 0.0f) * max(1.0f - abs(distance.y) / r, 0.0f) / (r * r);
}

// Share of the tents around a point that belong to texels from `low` to before `high`, along one axis, in texels: at the
// border of a view the others are missing.
GN_FN float gn_forward_share(float at, float low, float high, int radius) {
    if (radius == 0) {
        return 1.0f;
    }
    float sum = 0.0f;
    float first = floor(at) - float(radius) + 0.5f;
    for (int i = 0; i <= 2 * radius; ++i) {
        float centre = first + float(i);
        float weight = max(1.0f - abs(at - centre) / float(radius), 0.0f) / float(radius);
        sum += centre > low && centre < high ? weight : 0.0f;
    }
    return sum;
}

// The world position of a map point with linear depth: on the ray through it, where the view's depth is this.
GN_FN vec3 gn_forward_position(GnLightView view, vec2 uv_ts, float depth) {
    vec2 ndc = (uv_ts - vec2(view.rect_ts.x, view.rect_ts.y)) / vec2(view.rect_ts.z, view.rect_ts.w) * 2.0f - 1.0f;
    vec4 near_ws = view.ws_from_cs * vec4(ndc.x, ndc.y, 0.0f, 1.0f);
    vec4 far_ws = view.ws_from_cs * vec4(ndc.x, ndc.y, 1.0f, 1.0f);
    vec3 a_ws = view.eye_ws.w > 0.5f ? vec3(view.eye_ws) : vec3(near_ws) / near_ws.w;
    vec3 b_ws = vec3(far_ws) / far_ws.w;
    float a = dot(view.depth_from_ws, vec4(a_ws, 1.0f));
    float b = dot(view.depth_from_ws, vec4(b_ws, 1.0f));
    return a_ws + (b_ws - a_ws) * ((depth - a) / (b - a));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
