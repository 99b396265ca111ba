// SPDX-License-Identifier: MIT
// Where the view is split, and which cascade serves a receiver. Compiles as GLSL and as C++.
//
// Based on: Zhang, Sun, Xu, Lun. Parallel-Split Shadow Maps for Large-scale Virtual Environments. VRCIA 2006. [ZSXL06]
// Departs from it: the adapted near plane, and the choice by projection.
#ifndef GN_SHADOW_PLACEMENT_CASCADES_GLSL
#define GN_SHADOW_PLACEMENT_CASCADES_GLSL

#include "shadow/receiver/noise.glsl"
#include "shadow/placement/cascades/cascades.h"
#include "shadow/placement/faces.glsl"

// What a host may fix when it compiles: the number of cascades, GN_SELECT_* and GN_TRANSITION_*. Left open, all of it is
// decided receiver by receiver.
//   #define GN_CASCADES_COUNT 4
//   #define GN_CASCADES_SELECT 0
//   #define GN_CASCADES_TRANSITION 1
#if defined(__cplusplus) || !defined(GN_CASCADES_COUNT)
#define GN_CASCADES_COUNT data.count
#endif
#if defined(__cplusplus) || !defined(GN_CASCADES_SELECT)
#define GN_CASCADES_SELECT data.select
#endif
#if defined(__cplusplus) || !defined(GN_CASCADES_TRANSITION)
#define GN_CASCADES_TRANSITION data.transition
#endif

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Ends of cascades between near and far along the view axis; t = i / n of the ranges before the split.
GN_FN float gn_cascades_uniform(float near, float far, float t) { return near + (far - near) * t; }

GN_FN float gn_cascades_log(float near, float far, float t) { return near * pow(far / near, t); }

// Zhang's practical scheme: between both.
GN_FN float gn_cascades_practical(float near, float far, float t, float alpha) {
    return alpha * gn_cascades_log(near, far, t) + (1.0f - alpha) * gn_cascades_uniform(near, far, t);
}

// The near plane that the logarithm starts from where the true one is too close: every cascade spans a ratio of four.
GN_FN float gn_cascades_adapted_near(float near, float far, int count, float wanted) {
    float adapted = wanted > 0.0f ? wanted : far / pow(4.0f, float(count));
    return clamp(adapted, near, far);
}

// End of cascade `i` of `count` (i = 0: the near plane).
GN_FN float gn_cascades_split(GnCascadesParams params, float near, float far, int i) {
    if (i <= 0) {
        return near;
    }
    if (i >= params.count) {
        return far;
    }
    float t = float(i) / float(params.count);
    if (params.split == GN_SPLIT_UNIFORM) {
        return gn_cascades_uniform(near, far, t);
    }
    if (params.split == GN_SPLIT_PRACTICAL) {
        return gn_cascades_practical(near, far, t, params.alpha);
    }
    if (params.split == GN_SPLIT_ADAPTED_NEAR) {
        return gn_cascades_log(gn_cascades_adapted_near(near, far, params.count, params.adapted_near), far, t);
    }
    return gn_cascades_log(near, far, t);
}

// Position of p in cascade i, in clip units: its largest coordinate, 1 at the border.
GN_FN float gn_cascades_border(GnCascadesData data, int i, vec3 p_ws) {
    vec2 p_ls = vec2(dot(vec3(data.x_ws), p_ws), dot(vec3(data.y_ws), p_ws));
    float c = cos(data.angles[i]);
    float s = sin(data.angles[i]);
    vec4 fit = data.fits[i];
    return max(abs(fit.x * (c * p_ls.x + s * p_ls.y) + fit.z), abs(fit.y * (c * p_ls.y - s * p_ls.x) + fit.w));
}

// How often the side of map `i` of `count` is halved: a geometric row of sizes, away from the camera or towards it.
GN_FN int gn_cascades_halvings(int i, int count, float falloff) {
    float steps = falloff < 0.0f ? float(count - 1 - i) : float(i);
    return int(floor(steps * abs(falloff) + 1.0e-4f));
}

// Clip units up to which map i holds a receiver and its kernel, which is a larger share of a smaller map.
GN_FN float gn_cascades_limit(GnCascadesData data, int i) {
    uint halvings = (data.halved >> uint(4 * i)) & 15u;
    return halvings == 0u ? data.limit : 1.0f - min(0.8f, (1.0f - data.limit) * float(1u << halvings));
}

// Weight of the next cascade where `position` runs from 0 to 1 through a cascade: 0 before the band, 1 at its end.
GN_FN float gn_cascades_band(float position, float width) {
    return width > 0.0f ? clamp((position - (1.0f - width)) / width, 0.0f, 1.0f) : 0.0f;
}

GN_FN GnChoice gn_cascades_transition(int first, float weight, int transition, vec2 p_ss) {
    GnChoice choice = gn_only(first);
    if (transition == GN_TRANSITION_BLEND && weight > 0.0f) {
        choice.second = first + 1;
        choice.weight = weight;
    } else if (transition == GN_TRANSITION_DITHER && weight > gn_gradient_noise(p_ss)) {
        choice.first = first + 1;
    }
    return choice;
}

// Where a receiver stands: in which cascade, and where from its start (0) to its end (1).
struct GnCascadesPlace {
    int cascade;
    float position;
};

// The loops run over all cascades that there can be, so that they unroll and no index into `data` is computed: an array
// that is indexed by a variable is copied for every pixel.
GN_FN GnCascadesPlace gn_cascades_by_distance(GnCascadesData data, int count, float view_depth) {
    int i = 0;
    float start = data.near;
    float end = data.ends[0];
    for (int k = 1; k < GN_CASCADES_MOST; ++k) {
        if (k < count && view_depth > end) {
            i = k;
            start = end;
            end = data.ends[k];
        }
    }
    GnCascadesPlace place;
    place.cascade = i;
    place.position = (view_depth - start) / max(end - start, 1.0e-6f * end);
    return place;
}

// The first cascade that holds the receiver and its kernel has the finest texels.
GN_FN GnCascadesPlace gn_cascades_by_projection(GnCascadesData data, int count, vec3 p_ws) {
    int i = 0;
    float position = gn_cascades_border(data, 0, p_ws) / gn_cascades_limit(data, 0);
    float beyond = 0.0f;
    for (int k = 1; k < GN_CASCADES_MOST; ++k) {
        if (k < count && k == i + 1) {
            beyond = gn_cascades_border(data, k, p_ws) / gn_cascades_limit(data, k);
            if (position > 1.0f) {
                i = k;
                position = beyond;
                beyond = 0.0f;
            }
        }
    }
    // What the next cascade does not hold cannot be blended with it.
    GnCascadesPlace place;
    place.cascade = i;
    place.position = beyond > 1.0f ? 0.0f : position;
    return place;
}

GN_FN GnChoice gn_cascades_choose(GnReceiver receiver, GnCascadesData data) {
    int count = GN_CASCADES_COUNT;
    GnCascadesPlace place;
    if (GN_CASCADES_SELECT == GN_SELECT_PROJECTION) {
        place = gn_cascades_by_projection(data, count, receiver.p_ws);
    } else {
        place = gn_cascades_by_distance(data, count, receiver.view_depth);
    }
    float weight = place.cascade + 1 < count ? gn_cascades_band(place.position, data.width) : 0.0f;
    return gn_cascades_transition(place.cascade, weight, GN_CASCADES_TRANSITION, receiver.p_ss);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
