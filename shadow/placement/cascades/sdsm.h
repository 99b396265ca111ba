// SPDX-License-Identifier: MIT
// What the passes of sample distribution shadow maps share.
#ifndef GN_SHADOW_PLACEMENT_CASCADES_SDSM_H
#define GN_SHADOW_PLACEMENT_CASCADES_SDSM_H

#include "shadow/placement/cascades/cascades.h"
#include "shadow/scene/light.h"

#define GN_SDSM_BINS 256
#define GN_SDSM_ROWS 16
#define GN_SDSM_TURNS 6                       // rectangles that are tried, over a right angle
#define GN_SDSM_AXES (2 * GN_SDSM_TURNS + 1)  // directions of bounds: around the light's plane, then along the light

struct GnSdsmConstants {
    GnLight light;
    GnCascadesParams params;
    vec4 x_ws GN_DEFAULT(vec4(0));  ///< axes of the light's frame; w: the eye's coordinate along them
    vec4 y_ws GN_DEFAULT(vec4(0));
    vec4 z_ws GN_DEFAULT(vec4(0));
    vec4 eye_ws GN_DEFAULT(vec4(0));
    int even GN_DEFAULT(0);           ///< 1: pixels are of one size at every distance (orthographic)
    uvec2 size GN_DEFAULT(uvec2(0));  ///< of the view, pixels
    float near GN_DEFAULT(0.0f);      ///< of the camera: the histogram's range
    float far GN_DEFAULT(0.0f);
    float resolution GN_DEFAULT(0.0f);               ///< texels
    uint halved GN_DEFAULT(0u);                      ///< as in GnCascadesData
    vec4 rects_ts[GN_CASCADES_MOST] GN_DEFAULT({});  ///< of each map in its layer
    int layers[GN_CASCADES_MOST] GN_DEFAULT({});
    float guard_texels GN_DEFAULT(0.0f);
    float guard_metres GN_DEFAULT(0.0f);
    float guard_before GN_DEFAULT(0.0f);
};

/// Zeroed before every frame. Maxima of bits that order as the floats do; minima are maxima of their complements.
struct GnSdsmReduction {
    uint nearest;
    uint farthest;
    uint bins[GN_SDSM_BINS];                       ///< samples by the logarithm of their distance
    uint lowest[GN_SDSM_AXES * GN_CASCADES_MOST];  ///< bounds of each cascade's samples, relative to the eye
    uint highest[GN_SDSM_AXES * GN_CASCADES_MOST];
    float ends[GN_CASCADES_MOST + 1];  ///< of the slices, near first
};

#ifdef __cplusplus
using glm::cos;
using glm::sin;
#endif

/// Direction `axis` in the light's plane, in the axes of the light's frame.
GN_FN vec2 gn_sdsm_axis(int axis) {
    float angle = float(axis) * (1.57079633f / float(GN_SDSM_TURNS));
    return vec2(cos(angle), sin(angle));
}

#endif
