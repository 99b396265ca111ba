// SPDX-License-Identifier: MIT
// The view samples that a reduction reads: an invocation takes a column of GN_SDSM_ROWS pixels.
#include "shadow/placement/cascades/sdsm_steps.glsl"
layout(local_size_x = 64) in;

// The sample of a pixel, and whether it counts for the light.
bool fetch(ivec2 pixel, out vec3 p_ws, out float distance) {
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    p_ws = position.xyz;
    distance = normal.w;
    return position.w > 0.5 && distance > 0.0 && gn_counted(u.light, p_ws, normal.xyz);
}
