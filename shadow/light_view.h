// SPDX-License-Identifier: MIT
// One view from a light, as C++ and GLSL see it: how a world position becomes a texel and a depth.
//
// A shadow map is always a 2D array texture; view i owns a rectangle of one layer. Depth is linear for every placement,
// warped ones too: d = dot(depth_from_ws, vec4(p_ws, 1)), 0 at the near plane and 1 at the far plane of the view.
#ifndef GN_SHADOW_LIGHT_VIEW_H
#define GN_SHADOW_LIGHT_VIEW_H

#include "base/shared.h"

struct GnLightView {
    mat4 cs_from_ws GN_DEFAULT(mat4(1));  ///< clip space; z/w in [0,1], 0 near (only for rasterization)
    mat4 ws_from_cs GN_DEFAULT(mat4(1));
    vec4 depth_from_ws GN_DEFAULT(vec4(0));     ///< linear depth of a world point: a dot product
    vec4 rect_ts GN_DEFAULT(vec4(0, 0, 1, 1));  ///< texture rectangle in the layer: offset.xy, extent.zw, in [0,1]
    vec4 eye_ws
        GN_DEFAULT(vec4(0));  ///< w = 1: xyz the centre of projection; w = 0: xyz the direction towards the light
    float metres_per_depth GN_DEFAULT(1.0f);  ///< distance between near and far plane along the depth axis
    float resolution GN_DEFAULT(1.0f);        ///< texels of the whole layer along one side
    int layer GN_DEFAULT(0);
    float grid GN_DEFAULT(0.0f);  ///< affine views that keep their texels: rounds clip coordinates, see gn_clip; else 0
    /// What bends straight lines on the map. Above 0, a paraboloid: cs_from_ws gives metres in the light's frame, the map covers
    /// this far in the coordinates of shadow/receiver/paraboloid.glsl, depth is the distance. Below 0, logarithmic: the rows are
    /// those of shadow/receiver/logarithm.glsl, whose rate is its amount.
    float paraboloid GN_DEFAULT(0.0f);
};

#ifdef __cplusplus
#define GN_PRECISE
#else
#define GN_PRECISE precise
#endif

/// Clip position of a world point. Where `grid` is set, the x and y before the view's own offset are rounded to 1/256 of
/// a texel, by adding and subtracting a number so large that no finer bits remain. A view whose offset is a whole
/// number of texels, and whose resolution is a power of two, then adds it without any rounding: views that differ by
/// whole texels see a point at bit-equal places within its texel.
GN_FN vec4 gn_clip(GnLightView view, vec3 p_ws) {
    GN_PRECISE vec4 p_cs;
    if (view.grid == 0.0f) {
        p_cs = view.cs_from_ws * vec4(p_ws, 1.0f);
        return p_cs;
    }
    GN_PRECISE float x =
        view.cs_from_ws[0][0] * p_ws.x + view.cs_from_ws[1][0] * p_ws.y + view.cs_from_ws[2][0] * p_ws.z;
    GN_PRECISE float y =
        view.cs_from_ws[0][1] * p_ws.x + view.cs_from_ws[1][1] * p_ws.y + view.cs_from_ws[2][1] * p_ws.z;
    GN_PRECISE float z =
        view.cs_from_ws[0][2] * p_ws.x + view.cs_from_ws[1][2] * p_ws.y + view.cs_from_ws[2][2] * p_ws.z;
    GN_PRECISE float x_grid = (x + view.grid) - view.grid;
    GN_PRECISE float y_grid = (y + view.grid) - view.grid;
    p_cs = vec4(x_grid + view.cs_from_ws[3][0], y_grid + view.cs_from_ws[3][1], z + view.cs_from_ws[3][2], 1.0f);
    return p_cs;
}

#endif
