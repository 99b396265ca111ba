// SPDX-License-Identifier: MIT
// What the passes of sample distribution shadow maps share.
#ifndef GN_SHADOW_PLACEMENT_CASCADES_SDSM_H
#define GN_SHADOW_PLACEMENT_CASCADES_SDSM_H

#include "shadow/placement/cascades/cascades.h"
#include "shadow/scene/light.h"

#define GN_SDSM_BINS 256
#define GN_SDSM_ROWS 16

struct GnSdsmConstants {
    GnLight light;
    GnCascadesParams params;
    vec4 x_ws GN_DEFAULT(vec4(0));  ///< axes of the light's frame; w: the eye's coordinate along them
    vec4 y_ws GN_DEFAULT(vec4(0));
    vec4 z_ws GN_DEFAULT(vec4(0));
    vec4 eye_ws GN_DEFAULT(vec4(0));
    uvec2 size GN_DEFAULT(uvec2(0));  ///< of the view, pixels
    float near GN_DEFAULT(0.0f);      ///< of the camera: the histogram's range
    float far GN_DEFAULT(0.0f);
    float resolution GN_DEFAULT(0.0f);  ///< texels
    float guard_texels GN_DEFAULT(0.0f);
    float guard_metres GN_DEFAULT(0.0f);
};

/// Zeroed before every frame. Maxima of bits that order as the floats do; minima are maxima of their complements.
struct GnSdsmReduction {
    uint nearest;
    uint farthest;
    uint bins[GN_SDSM_BINS];            ///< samples by the logarithm of their distance
    uint lowest[3 * GN_CASCADES_MOST];  ///< light space bounds, three a cascade, relative to the eye
    uint highest[3 * GN_CASCADES_MOST];
    float ends[GN_CASCADES_MOST + 1];  ///< of the slices, near first
};

#endif
