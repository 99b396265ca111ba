// SPDX-License-Identifier: MIT
// Parameters of cascaded shadow maps, and what their choice is given.
#ifndef GN_SHADOW_PLACEMENT_CASCADES_H
#define GN_SHADOW_PLACEMENT_CASCADES_H

#include "base/shared.h"

#define GN_CASCADES_MOST 8

#define GN_SPLIT_UNIFORM 0
#define GN_SPLIT_LOG 1
#define GN_SPLIT_PRACTICAL 2
#define GN_SPLIT_ADAPTED_NEAR 3
#define GN_SPLIT_SDSM_MINMAX 4
#define GN_SPLIT_SDSM_HISTOGRAM 5

#define GN_FIT_PLAIN 0
#define GN_FIT_FITTED 1
#define GN_FIT_STABLE 2
#define GN_FIT_WARPED 3

#define GN_TRANSITION_NONE 0
#define GN_TRANSITION_BLEND 1
#define GN_TRANSITION_DITHER 2

#define GN_SELECT_DISTANCE 0
#define GN_SELECT_PROJECTION 1

#define GN_FAR_SCENE 0
#define GN_FAR_OBJECTS 1

#define GN_PASSES_AUTO 0
#define GN_PASSES_LAYERED 1
#define GN_PASSES_SEPARATE 2

/// What the choice of a cascade is given.
struct GnCascadesData {
    int count GN_DEFAULT(0);
    int transition GN_DEFAULT(0);
    int select GN_DEFAULT(0);
    float width GN_DEFAULT(0.0f);                 ///< as in the parameters
    float near GN_DEFAULT(0.0f);                  ///< metres along the view, where the first begins
    float ends[GN_CASCADES_MOST] GN_DEFAULT({});  ///< where each ends
    float limit GN_DEFAULT(0.0f);   ///< clip units up to which a whole layer holds a receiver and its kernel
    vec4 x_ws GN_DEFAULT(vec4(0));  ///< the light's axes, w = 0
    vec4 y_ws GN_DEFAULT(vec4(0));
    vec4 fits[GN_CASCADES_MOST] GN_DEFAULT({});     ///< of each: scale u, v and offset u, v in clip units
    float angles[GN_CASCADES_MOST] GN_DEFAULT({});  ///< of each u, in the plane of the axes; radians
    uint halved GN_DEFAULT(0u);  ///< how often the side of each map is halved, four bits each, the first in the lowest
};

struct GnCascadesParams {
    int count GN_DEFAULT(4);
    float falloff GN_DEFAULT(0.0f);  ///< halvings of the side from one map to the next; below 0 towards the camera
    int split GN_DEFAULT(GN_SPLIT_PRACTICAL);
    float alpha GN_DEFAULT(0.8f);         ///< of practical: 0 uniform, 1 logarithmic
    float adapted_near GN_DEFAULT(0.0f);  ///< metres; 0: each cascade spans a ratio of four
    float distance GN_DEFAULT(0.0f);      ///< metres to the end of the last cascade; 0: as far as the scene reaches
    int far GN_DEFAULT(GN_FAR_SCENE);     ///< what the last cascade ends at
    int fit GN_DEFAULT(GN_FIT_STABLE);
    int snap GN_DEFAULT(1);  ///< stable windows move by whole texels
    int transition GN_DEFAULT(GN_TRANSITION_BLEND);
    float width GN_DEFAULT(0.1f);  ///< of the transition, as a share of the nearer cascade
    int select GN_DEFAULT(GN_SELECT_DISTANCE);
    int passes GN_DEFAULT(GN_PASSES_AUTO);
    int rate GN_DEFAULT(1);               ///< frames between redraws of the last cascade
    int scroll GN_DEFAULT(0);             ///< keep maps over frames and draw only what the window newly shows
    float least_caster GN_DEFAULT(0.0f);  ///< texels: what spans fewer of a map is not drawn into it
    float simpler GN_DEFAULT(0.0f);       ///< texels by which casters of all maps but the first may differ
    int mask GN_DEFAULT(0);               ///< leave out what casts onto nothing that is seen
};

#endif
