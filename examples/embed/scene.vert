// SPDX-License-Identifier: MIT
#version 460
// The objects of one mesh, each under its own transform.
layout(location = 0) in vec3 position_os;
layout(location = 1) in vec3 normal_os;
layout(location = 0) out vec3 normal_ws;
layout(location = 1) flat out vec4 color;
layout(binding = 0, std430) readonly buffer Transforms { mat4 ws_from_os[]; };
layout(binding = 1, std430) readonly buffer Colors { vec4 colors[]; };
layout(push_constant) uniform Push { mat4 cs_from_ws; } push;

void main() {
    mat4 m = ws_from_os[gl_InstanceIndex];
    gl_Position = push.cs_from_ws * (m * vec4(position_os, 1.0));
    // The axes are at right angles, so that dividing by their squared lengths inverts and transposes.
    mat3 axes = mat3(m);
    normal_ws = axes * (normal_os / vec3(dot(axes[0], axes[0]), dot(axes[1], axes[1]), dot(axes[2], axes[2])));
    color = colors[gl_InstanceIndex];
}
