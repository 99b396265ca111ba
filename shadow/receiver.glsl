// SPDX-License-Identifier: MIT
// What a lookup is given: the receiver, projected into one light view, with the bias applied.
//
// Space suffixes: _ws world, _cs the light's clip space, _ts texture space of the map's layer ([0,1]^2).
#ifndef GN_SHADOW_RECEIVER_GLSL
#define GN_SHADOW_RECEIVER_GLSL

#include "base/shared.h"
#include "shadow/bias.h"
#include "shadow/light_view.h"
#include "shadow/scene/light.h"

// A view sample as every stage sees it.
struct GnReceiver {
    vec3 p_ws;
    vec3 n_ws;        // geometric normal, towards the camera
    vec3 to_light;    // unit, towards the light's centre
    float view_depth; // metres along the camera's axis
    vec2 p_ss;        // pixel centre, in pixels
};

// The receiver in one light view. `plane` gives the depth of the receiver's plane at any point of the map:
// depth(uv) = dot(plane_num, vec3(uv, 1)) / dot(plane_den, vec3(uv, 1)).
struct GnProjected {
    vec2 uv_ts;       // in the layer
    float depth;      // linear depth of the (biased) receiver
    int layer;
    vec3 plane_num, plane_den;
    vec2 texel_ts;    // one texel in ts: 1 / resolution
    vec2 metres_per_ts; // world length, at the receiver and across the light's rays, of a unit step in u and in v
    float texel_ws;   // world size of a texel at the receiver, metres (the larger of both directions)
    vec4 bounds_ts;   // min.xy, max.zw: the view's rectangle
    float metres_per_depth;
    int inside;       // 1 when uv_ts lies in the view's rectangle and before its eye
};


#endif
