// SPDX-License-Identifier: MIT
// The mean of what frames said of a sample, each by how much it could know. Compiles as GLSL and as C++.
// Based on: Scherzer, Jeschke, Wimmer. Pixel-Correct Shadow Maps with Temporal Reprojection and Shadow Test Confidence. EGSR
// 2007. [SJW07]
// Departs from it: the sum of the weights is kept beside the mean, so that a still view has their true mean.
#ifndef GN_SHADOW_VISIBILITY_TEMPORAL_GLSL
#define GN_SHADOW_VISIBILITY_TEMPORAL_GLSL

#include "shadow/scene/light.h"
#include "shadow/visibility/temporal/temporal.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What a frame weighs whose texel's centre is so near: conf^m.
GN_FN float gn_temporal_weight(float confidence, GnTemporalParams params) { return pow(confidence, params.exponent); }

// The share of a frame in the mean, after frames that weighed `before` together: all of it where there were none.
GN_FN float gn_temporal_share(float before, float weight) { return before > 0.0f ? weight / (before + weight) : 1.0f; }

// What all frames weigh after it, of which no more is remembered than `memory` frames that are certain.
GN_FN float gn_temporal_sum(float before, float weight, GnTemporalParams params) {
    return min(before + weight, params.memory);
}

// Whether a way from a point, `longest` times `way_ws` long, meets a box that is grown by `grow` to all sides.
GN_FN bool gn_temporal_meets(vec3 p_ws, vec3 way_ws, float longest, vec3 low_ws, vec3 high_ws, float grow) {
    float near = 0.0f;
    float far = longest;
    for (int axis = 0; axis < 3; ++axis) {
        float way = abs(way_ws[axis]) > 1.0e-20f ? way_ws[axis] : 1.0e-20f;
        float first = (low_ws[axis] - grow - p_ws[axis]) / way;
        float second = (high_ws[axis] + grow - p_ws[axis]) / way;
        near = max(near, min(first, second));
        far = min(far, max(first, second));
    }
    return near <= far;
}

// How far beside the ray to the light's middle something can hide a part of the light from a point, at any place of a box.
GN_FN float gn_temporal_penumbra(GnLight light, vec3 p_ws, vec3 low_ws, vec3 high_ws) {
    if (light.kind == uint(GN_LIGHT_DIRECTIONAL)) {
        return tan(light.angular_radius) * length(max(abs(high_ws - p_ws), abs(p_ws - low_ws)));
    }
    return light.kind == uint(GN_LIGHT_RECTANGLE) ? length(light.half_size) : light.radius;
}

// Whether what moved within a box can change the shadow at a point: it lies between the point and the light, or at the point.
GN_FN bool gn_temporal_touches(GnLight light, vec3 p_ws, vec3 low_ws, vec3 high_ws, float reach_ws) {
    bool far = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    vec3 way_ws = far ? -vec3(light.direction_ws) : vec3(light.position_ws) - p_ws;
    float grow = reach_ws + gn_temporal_penumbra(light, p_ws, low_ws, high_ws);
    return gn_temporal_meets(p_ws, way_ws, far ? 1.0e30f : 1.0f, low_ws, high_ws, grow);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
