// SPDX-License-Identifier: MIT
// The camera's constants, as shadow/stages.h has them, and how a pass reads one view sample.
#ifndef GN_SHADOW_VIEW_VIEW_GLSL
#define GN_SHADOW_VIEW_VIEW_GLSL

#include "shadow/receiver/receiver.glsl"

struct GnViewConstants {
    mat4 cs_from_ws;
    mat4 ws_from_cs;
    vec4 eye_ws;
    uvec4 size;
};

// A step of one pixel along the receiver's plane: the plane cut with the neighbouring pixel's ray.
vec3 gn_plane_step(vec3 p_ws, vec3 n_ws, vec3 eye_ws, vec3 neighbour_ray_ws) {
    float towards_plane = dot(n_ws, neighbour_ray_ws);
    float t = dot(n_ws, p_ws - eye_ws) / (abs(towards_plane) > 1.0e-6 ? towards_plane : 1.0e-6);
    return eye_ws + t * neighbour_ray_ws - p_ws;
}

// The receiver of a pixel from its two G-buffer texels.
GnReceiver gn_receiver(GnViewConstants view, ivec2 pixel, vec4 position, vec4 normal) {
    GnReceiver receiver;
    receiver.p_ws = position.xyz;
    receiver.n_ws = normal.xyz;
    receiver.view_depth = normal.w;
    receiver.p_ss = vec2(pixel) + 0.5;
    vec2 size = vec2(view.size.xy);
    vec4 right = view.ws_from_cs * vec4((receiver.p_ss + vec2(1, 0)) / size * 2.0 - 1.0, 0.5, 1.0);
    vec4 below = view.ws_from_cs * vec4((receiver.p_ss + vec2(0, 1)) / size * 2.0 - 1.0, 0.5, 1.0);
    receiver.ddx_ws = gn_plane_step(receiver.p_ws, receiver.n_ws, view.eye_ws.xyz, right.xyz / right.w - view.eye_ws.xyz);
    receiver.ddy_ws = gn_plane_step(receiver.p_ws, receiver.n_ws, view.eye_ws.xyz, below.xyz / below.w - view.eye_ws.xyz);
    receiver.to_camera_ws = normalize(view.eye_ws.xyz - receiver.p_ws);
    receiver.object = -1;
    return receiver;
}

#endif
