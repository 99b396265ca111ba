// SPDX-License-Identifier: MIT
#version 460
// The objects as a light sees them, in a view that Gnomon has begun.
layout(location = 0) in vec3 position_os;
layout(location = 0) out float depth;
layout(binding = 0, std430) readonly buffer Transforms { mat4 ws_from_os[]; };
layout(push_constant) uniform Push {
    mat4 cs_from_ws;
    vec4 depth_from_ws;
    float grid;
} push;

void main() {
    vec3 p_ws = vec3(ws_from_os[gl_InstanceIndex] * vec4(position_os, 1.0));
    // Maps that keep their texels want places rounded before the view's own offset is added.
    precise vec4 p_cs = push.cs_from_ws * vec4(p_ws, 0.0);
    if (push.grid != 0.0) {
        p_cs.xy = (p_cs.xy + push.grid) - push.grid;
    }
    gl_Position = p_cs + push.cs_from_ws[3];
    depth = dot(push.depth_from_ws, vec4(p_ws, 1.0));
}
