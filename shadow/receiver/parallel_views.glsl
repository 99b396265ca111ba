// SPDX-License-Identifier: MIT
// Views that look one way along the same axes, as cascades do: they differ in scale and offset alone. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_PARALLEL_VIEWS_GLSL
#define GN_SHADOW_PARALLEL_VIEWS_GLSL

#include "shadow/light_view.h"

#ifdef __cplusplus
namespace gn {
#endif

// What they share: unit directions along which x and y of clip space and linear depth grow, w = 0.
struct GnViewAxes {
    vec4 x_ws;
    vec4 y_ws;
    vec4 depth_ws;
};

// What is left of one: scales along x and y, offsets of x and y; scale and offset of its depth.
struct GnViewPlace {
    vec4 clip;
    vec4 depth;
};

// The view with its rows of x, y and depth made of both; all else as it is.
GN_FN GnLightView gn_along_axes(GnLightView view, GnViewAxes axes, GnViewPlace place) {
    vec3 x = place.clip.x * vec3(axes.x_ws);
    vec3 y = place.clip.y * vec3(axes.y_ws);
    view.cs_from_ws[0] = vec4(x.x, y.x, view.cs_from_ws[0].z, view.cs_from_ws[0].w);
    view.cs_from_ws[1] = vec4(x.y, y.y, view.cs_from_ws[1].z, view.cs_from_ws[1].w);
    view.cs_from_ws[2] = vec4(x.z, y.z, view.cs_from_ws[2].z, view.cs_from_ws[2].w);
    view.cs_from_ws[3] = vec4(place.clip.z, place.clip.w, view.cs_from_ws[3].z, view.cs_from_ws[3].w);
    view.depth_from_ws = vec4(place.depth.x * vec3(axes.depth_ws), place.depth.y);
    return view;
}

#ifdef __cplusplus
}  // namespace gn
#endif
#endif
