// SPDX-License-Identifier: MIT
// Where the view is split, and which cascade serves a receiver. Compiles as GLSL and as C++.
//
// Based on: Zhang, Sun, Xu, Lun. Parallel-Split Shadow Maps for Large-scale Virtual Environments. VRCIA 2006. [ZSXL06]
// Departs from it: the adapted near plane, and the choice by projection.
#ifndef GN_SHADOW_PLACEMENT_CASCADES_GLSL
#define GN_SHADOW_PLACEMENT_CASCADES_GLSL

#include "shadow/placement/cascades/cascades.h"
#include "shadow/placement/faces.glsl"

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

// What the placement packs into GnPlacementData:
//   [0] count, transition, select, width       [1..2] ends of cascades 1 to 8     [3] near, limit in clip units, 0, 0
//   [4..5] the light's axes x and y, 0          [6..13] per cascade: scale u, v and offset u, v in clip units
//   [14..15] per cascade: angle of u in the plane of the axes
GN_FN float gn_cascades_of8(vec4 low, vec4 high, int i) { return i < 4 ? low[i] : high[i - 4]; }

GN_FN float gn_cascades_end(GnPlacementData data, int i) {
    return i < 0 ? data.values[3].x : gn_cascades_of8(data.values[1], data.values[2], i);
}

// Position of p in cascade i, in clip units: its largest coordinate, 1 at the border.
GN_FN float gn_cascades_border(GnPlacementData data, int i, vec3 p_ws) {
    vec2 p_ls = vec2(dot(vec3(data.values[4]), p_ws), dot(vec3(data.values[5]), p_ws));
    float angle = gn_cascades_of8(data.values[14], data.values[15], i);
    float c = cos(angle);
    float s = sin(angle);
    vec4 fit = data.values[6 + i];
    return max(abs(fit.x * (c * p_ls.x + s * p_ls.y) + fit.z), abs(fit.y * (c * p_ls.y - s * p_ls.x) + fit.w));
}

// Weight of the next cascade where `position` runs from 0 to 1 through a cascade: 0 before the band, 1 at its end.
GN_FN float gn_cascades_band(float position, float width) {
    return width > 0.0f ? clamp((position - (1.0f - width)) / width, 0.0f, 1.0f) : 0.0f;
}

// A threshold per pixel from interleaved gradient noise. [Jim14]
GN_FN float gn_cascades_noise(vec2 p_ss) {
    float inner = 0.06711056f * p_ss.x + 0.00583715f * p_ss.y;
    inner = 52.9829189f * (inner - floor(inner));
    return inner - floor(inner);
}

GN_FN GnChoice gn_cascades_transition(int first, float weight, int transition, vec2 p_ss) {
    GnChoice choice = gn_only(first);
    if (transition == GN_TRANSITION_BLEND && weight > 0.0f) {
        choice.second = first + 1;
        choice.weight = weight;
    } else if (transition == GN_TRANSITION_DITHER && weight > gn_cascades_noise(p_ss)) {
        choice.first = first + 1;
    }
    return choice;
}

GN_FN GnChoice gn_cascades_choose(GnReceiver receiver, GnPlacementData data) {
    int count = int(data.values[0].x);
    int transition = int(data.values[0].y);
    float width = data.values[0].w;
    int i = 0;
    float position = 0.0f;
    if (int(data.values[0].z) == GN_SELECT_PROJECTION) {
        // The first cascade that holds the receiver and its kernel has the finest texels.
        float limit = data.values[3].y;
        position = gn_cascades_border(data, 0, receiver.p_ws) / limit;
        while (i + 1 < count && position > 1.0f) {
            i += 1;
            position = gn_cascades_border(data, i, receiver.p_ws) / limit;
        }
        // What the next cascade does not hold cannot be blended with it.
        if (i + 1 < count && gn_cascades_border(data, i + 1, receiver.p_ws) > limit) {
            position = 0.0f;
        }
    } else {
        while (i + 1 < count && receiver.view_depth > gn_cascades_end(data, i)) {
            i += 1;
        }
        float start = gn_cascades_end(data, i - 1);
        position = (receiver.view_depth - start) / max(gn_cascades_end(data, i) - start, 1.0e-6f);
    }
    float weight = i + 1 < count ? gn_cascades_band(position, width) : 0.0f;
    return gn_cascades_transition(i, weight, transition, receiver.p_ss);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
