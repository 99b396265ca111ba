// SPDX-License-Identifier: MIT
// The view samples that a reduction reads: an invocation takes a column of GN_SDSM_ROWS pixels.
#include "shadow/placement/cascades/sdsm_bindings.glsl"
layout(local_size_x = 64) in;
layout(binding = 2) uniform sampler2D gbuffer_position;
layout(binding = 3) uniform sampler2D gbuffer_normal;

// The sample of a pixel, and whether it counts for the light.
bool fetch(ivec2 pixel, out vec3 p_ws, out float distance) {
    vec4 position = texelFetch(gbuffer_position, pixel, 0);
    vec4 normal = texelFetch(gbuffer_normal, pixel, 0);
    p_ws = position.xyz;
    distance = normal.w;
    return position.w > 0.5 && distance > 0.0 && gn_counted(u.light, p_ws, normal.xyz);
}
