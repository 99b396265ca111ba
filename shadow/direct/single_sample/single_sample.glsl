// SPDX-License-Identifier: MIT
// Based on: Parker, Shirley, Smits. Single Sample Soft Shadows. University of Utah, UUCS-98-019, 1998. [PSS98]
//
// It compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_SINGLE_SAMPLE_GLSL
#define GN_SHADOW_DIRECT_SINGLE_SAMPLE_GLSL

#include "shadow/direct/single_sample/single_sample.h"
#include "shadow/geometry/seen_light.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Distance from the middle to a segment.
GN_FN float gn_single_sample_distance(vec2 a, vec2 b) {
    vec2 along = b - a;
    float length2 = dot(along, along);
    float t = length2 > 0.0f ? clamp(-dot(a, along) / length2, 0.0f, 1.0f) : 0.0f;
    vec2 nearest = a + along * t;
    return sqrt(dot(nearest, nearest));
}

// tau = x / b, [PSS98] section 3: how far the ray to the light's centre passes the edge, of the width b = a D / A that the cone to
// the light of width D has there. On the light's plane, in half widths of the light, that is half the distance of the edge
// from the middle. 1 where the edge is out of the way.
GN_FN float gn_single_sample_tau(GnLight light, vec3 p_ws, vec3 a_ws, vec3 b_ws) {
    GnSeenLight seen = gn_seen_light(light, p_ws);
    vec3 from_a = a_ws - p_ws;
    vec3 from_b = b_ws - p_ws;
    if (!gn_between(seen, light.kind == uint(GN_LIGHT_DIRECTIONAL), from_a, from_b)) {
        return 1.0f;
    }
    return min(0.5f * gn_single_sample_distance(gn_on_light(seen, from_a), gn_on_light(seen, from_b)), 1.0f);
}

// s of tau, [PSS98] section 3: (1 + sin(pi tau - pi/2)) / 2, or nearly the same, 3 tau^2 - 2 tau^3.
GN_FN float gn_single_sample_light(float tau, int profile) {
    return profile == GN_SINGLE_SAMPLE_SINE ? 0.5f + 0.5f * sin(3.14159265f * (tau - 0.5f)) : tau * tau * (3.0f - 2.0f * tau);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
