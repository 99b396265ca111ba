// SPDX-License-Identifier: MIT
// One view from a light, as C++ and GLSL see it: how a world position becomes a texel and a depth.
//
// A shadow map is always a 2D array texture; view i owns a rectangle of one layer. Depth is linear for every placement,
// warped ones too: d = dot(depth_from_ws, vec4(p_ws, 1)), 0 at the near plane and 1 at the far plane of the view.
#ifndef GN_SHADOW_LIGHT_VIEW_H
#define GN_SHADOW_LIGHT_VIEW_H

#include "base/shared.h"

struct GnLightView {
    mat4 cs_from_ws GN_DEFAULT(mat4(1));          ///< clip space; z/w in [0,1], 0 near (only for rasterization)
    mat4 ws_from_cs GN_DEFAULT(mat4(1));
    vec4 depth_from_ws GN_DEFAULT(vec4(0));       ///< linear depth of a world point: a dot product
    vec4 rect_ts GN_DEFAULT(vec4(0, 0, 1, 1));    ///< texture rectangle in the layer: offset.xy, extent.zw, in [0,1]
    vec4 eye_ws GN_DEFAULT(vec4(0));              ///< w = 1: xyz the centre of projection; w = 0: xyz the direction towards the light
    float metres_per_depth GN_DEFAULT(1.0f);      ///< distance between near and far plane along the depth axis
    float resolution GN_DEFAULT(1.0f);            ///< texels of the whole layer along one side
    int layer GN_DEFAULT(0);
    int affine_depth GN_DEFAULT(1);               ///< 1: rasterized z/w already is the linear depth (no fragment shader needed)
};

#endif
