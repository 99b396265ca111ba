// SPDX-License-Identifier: MIT
// Lookups that only fetch: the bottom line that shadow lookups are measured against.
#ifndef GN_TESTS_PERFORMANCE_FETCH_GLSL
#define GN_TESTS_PERFORMANCE_FETCH_GLSL

#include "shadow/receiver.glsl"

// The texel that `hard` compares with.
float gn_fetch_one_visibility(GnReceiver receiver, GnProjected projected, GnBias bias, sampler2DArray map) {
    return texelFetch(map, ivec3(ivec2(floor(projected.uv_ts / projected.texel_ts)), projected.layer), 0).r;
}

// The texels that `pcf` with kernel=3x3 compares with: four gathers.
float gn_fetch_grid_visibility(GnReceiver receiver, GnProjected projected, GnBias bias, sampler2DArray map) {
    vec2 first = floor(projected.uv_ts / projected.texel_ts) - 1.0;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 4; y += 2) {
        for (int x = 0; x < 4; x += 2) {
            sum += textureGather(map, vec3((first + vec2(x, y) + 1.0) * projected.texel_ts, projected.layer));
        }
    }
    return dot(sum, vec4(0.0625));
}

#endif
