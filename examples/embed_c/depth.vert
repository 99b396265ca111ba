// SPDX-License-Identifier: MIT
#version 460
// Depth alone: there is no fragment shader.
layout(location = 0) in vec3 position_os;
layout(push_constant) uniform Push { mat4 cs_from_os; } push;

void main() {
    gl_Position = push.cs_from_os * vec4(position_os, 1.0);
}
