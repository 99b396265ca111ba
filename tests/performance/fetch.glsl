// SPDX-License-Identifier: MIT
// Lookups that only fetch: the bottom line that shadow lookups are measured against.
#ifndef GN_TESTS_PERFORMANCE_FETCH_GLSL
#define GN_TESTS_PERFORMANCE_FETCH_GLSL

#include "shadow/lookup/pcf/pcf.glsl"

// The texel that `hard` compares with.
float gn_fetch_one_visibility(GnLookup at, sampler2DArray map) {
    GnProjected projected = at.projected;
    return texelFetch(map, ivec3(ivec2(floor(projected.uv_ts / projected.texel_ts)), projected.layer), 0).r;
}

// The texels that a grid kernel of `pcf` compares with: one gather for four.
float gn_fetch_gathers_visibility(GnLookup at, sampler2DArray map, GnPcfParams params) {
    GnProjected projected = at.projected;
    vec2 t = projected.uv_ts / projected.texel_ts;
    ivec2 first = ivec2(gn_pcf_first(GN_PCF_KERNEL, GN_PCF_SIZE, t.x), gn_pcf_first(GN_PCF_KERNEL, GN_PCF_SIZE, t.y));
    vec4 sum = vec4(0.0);
    for (int y = 0; y < GN_PCF_FOOTPRINT; y += 2) {
        for (int x = 0; x < GN_PCF_FOOTPRINT; x += 2) {
            sum += textureGather(map, vec3(vec2(first + ivec2(x, y) + 1) * projected.texel_ts, projected.layer));
        }
    }
    return dot(sum, vec4(1.0 / float(GN_PCF_FOOTPRINT * GN_PCF_FOOTPRINT)));
}

// The texels that a disc kernel of `pcf` compares with, at the same places.
float gn_fetch_four(GnProjected projected, sampler2DArray map, vec2 radius_ts, vec2 turn, vec4 x, vec4 y) {
    vec2 last_ts = projected.bounds_ts.zw - 0.5 * projected.texel_ts;
    float sum = 0.0;
    for (int k = 0; k < 4; ++k) {
        vec2 turned = vec2(turn.x * x[k] - turn.y * y[k], turn.y * x[k] + turn.x * y[k]);
        vec2 tap_ts = clamp(projected.uv_ts + radius_ts * turned, projected.bounds_ts.xy, last_ts);
        sum += texelFetch(map, ivec3(ivec2(floor(tap_ts / projected.texel_ts)), projected.layer), 0).r;
    }
    return sum;
}

float gn_fetch_taps_visibility(GnLookup at, sampler2DArray map, GnPcfParams params) {
    GnProjected projected = at.projected;
    vec2 radius_ts = vec2(params.radius * projected.texel_ts);
    float angle = GN_PCF_KERNEL == GN_PCF_POISSON ? 0.0 : gn_pcf_angle(at.receiver.p_ss);
    vec2 turn = vec2(cos(angle), sin(angle));
    float sum = 0.0;
#ifdef GN_PCF_PROBES
#define GN_FETCH_TAKE(x, y, counted) sum += gn_fetch_four(projected, map, radius_ts, turn, x, y);
    GN_PCF_PROBES(GN_FETCH_TAKE)
    GN_PCF_OTHERS(GN_FETCH_TAKE)
#endif
    return sum / float(GN_PCF_TAPS);
}

#endif
