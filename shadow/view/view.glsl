// SPDX-License-Identifier: MIT
// The camera's constants, as shadow/stages.h has them, and how a pass reads one view sample.
#ifndef GN_SHADOW_VIEW_VIEW_GLSL
#define GN_SHADOW_VIEW_VIEW_GLSL

#include "shadow/receiver/receiver.glsl"

struct GnViewConstants {
    mat4 cs_from_ws;
    vec4 eye_ws;
    vec4 axis_ws;
    vec4 right_ws;
    vec4 down_ws;
    uvec4 size;
};

// From a point towards the eye, not of unit length.
vec3 gn_ray_to_eye(GnViewConstants view, vec3 p_ws) { return view.eye_ws.xyz - p_ws * view.eye_ws.w; }

// By how much pixels are larger at a distance along the axis than right_ws and down_ws: an orthographic camera sees
// everything at one size.
float gn_pixel_growth(GnViewConstants view, float distance) { return view.eye_ws.w > 0.5 ? distance : 1.0; }

// A step of one pixel along the receiver's plane: across the view to the neighbour's ray, and on it to the plane. Only
// differences of positions are taken, never points near the eye, which are known to the rounding of its coordinates alone.
vec3 gn_plane_step(GnViewConstants view, vec3 p_ws, vec3 n_ws, vec3 across_ws) {
    vec3 ray_ws = across_ws * view.eye_ws.w - gn_ray_to_eye(view, p_ws);
    float towards_plane = dot(n_ws, ray_ws);
    float least = 1.0e-6 * length(ray_ws);
    return across_ws - ray_ws * (dot(n_ws, across_ws) / (abs(towards_plane) > least ? towards_plane : least));
}

// The receiver of a pixel from its two G-buffer texels.
GnReceiver gn_receiver(GnViewConstants view, ivec2 pixel, vec4 position, vec4 normal) {
    GnReceiver receiver;
    receiver.p_ws = position.xyz;
    receiver.n_ws = normal.xyz;
    receiver.view_depth = normal.w;
    receiver.p_ss = vec2(pixel) + 0.5;
    float growth = gn_pixel_growth(view, normal.w);
    receiver.ddx_ws = gn_plane_step(view, receiver.p_ws, receiver.n_ws, growth * view.right_ws.xyz);
    receiver.ddy_ws = gn_plane_step(view, receiver.p_ws, receiver.n_ws, growth * view.down_ws.xyz);
    receiver.to_camera_ws = normalize(gn_ray_to_eye(view, receiver.p_ws));
    receiver.object = -1;
    return receiver;
}

#endif
