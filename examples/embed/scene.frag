// SPDX-License-Identifier: MIT
#version 460
// What later passes know of a pixel: the normal in two components, and the surface's colour.
layout(location = 0) in vec3 normal_ws;
layout(location = 1) flat in vec4 color;
layout(location = 0) out vec2 normal;
layout(location = 1) out vec4 albedo;

// The unit vector on the octahedron, unfolded into [-1,1] each.
vec2 to_octahedral(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 signs = vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * signs;
}

void main() {
    normal = to_octahedral(normalize(normal_ws));
    albedo = color;
}
