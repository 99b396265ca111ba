// SPDX-License-Identifier: MIT
// A ray from a sample to the light against one triangle, decided as the truth does. Compiles as GLSL and as C++; 64-bit where
// volumes.glsl is.
#ifndef GN_SHADOW_GEOMETRY_TRIANGLE_GLSL
#define GN_SHADOW_GEOMETRY_TRIANGLE_GLSL

#include "shadow/geometry/volumes.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Whether a triangle is the surface that a sample lies on: it faces as the sample does, and as near as interpolated positions
// are to their surface (64 units of the coordinates, as the truth seats its samples).
GN_FN bool gn_triangle_own(vec3 p_ws, vec3 n_ws, vec3 a_ws, vec3 b_ws, vec3 c_ws) {
    vec3 n = cross(b_ws - a_ws, c_ws - a_ws);
    float facing = dot(n, n_ws);
    vec3 most = max(max(abs(a_ws), abs(b_ws)), max(abs(c_ws), abs(p_ws)));
    float height = abs(dot(n, p_ws - a_ws)), reach = 64.0f / 8388608.0f * max(most.x, max(most.y, most.z));
    return abs(facing) > 0.99f * length(n) && height <= reach * abs(facing);
}

// Whether the line from a sample to the light surely misses a triangle, by more than 32-bit arithmetic can err: what most
// samples are told before the exact answer is worked out.
GN_FN bool gn_triangle_missed(vec3 p_ws, vec4 light_ws, vec3 a_ws, vec3 b_ws, vec3 c_ws) {
    vec3 a = a_ws - p_ws, b = b_ws - p_ws, c = c_ws - p_ws, way = vec3(light_ws) - p_ws * light_ws.w;
    float u = dot(way, cross(b, c)), v = dot(way, cross(c, a)), w = dot(way, cross(a, b));
    float slack = 1.0e-5f * length(way) * max(dot(a, a), max(dot(b, b), dot(c, c)));
    return min(u, min(v, w)) < -slack && max(u, max(v, w)) > slack;
}

// Where the segment from a sample to the light meets a triangle: the weights of its corners, and w = 1, or 0 where it does not.
// The sample and the light lie on two sides of the plane, and the ray passes all three edges on one side. What passes an edge by
// less than a millionth of the triangle meets both neighbours, so that no ray slips between them.
GN_FN vec4 gn_triangle_hit(vec3 p_ws, vec4 light_ws, vec3 a_ws, vec3 b_ws, vec3 c_ws) {
    GN_VOLUMES_VEC3 p = GN_VOLUMES_VEC3(p_ws);
    GN_VOLUMES_VEC3 a = GN_VOLUMES_VEC3(a_ws) - p, b = GN_VOLUMES_VEC3(b_ws) - p, c = GN_VOLUMES_VEC3(c_ws) - p;
    GN_VOLUMES_VEC3 way = GN_VOLUMES_VEC3(vec3(light_ws)) - p * GN_VOLUMES_REAL(light_ws.w);
    GN_VOLUMES_VEC3 n = cross(b - a, c - a);
    GN_VOLUMES_REAL start = -dot(n, a), end = start * GN_VOLUMES_REAL(light_ws.w) + dot(n, way);
    GN_VOLUMES_REAL u = dot(way, cross(b, c)), v = dot(way, cross(c, a)), w = dot(way, cross(a, b)), sum = u + v + w;
    GN_VOLUMES_REAL least = min(u, min(v, w)), most = max(u, max(v, w)), slack = abs(sum) * GN_VOLUMES_REAL(1.0e-6);
    bool through = sum > GN_VOLUMES_REAL(0) ? least >= -slack : sum < GN_VOLUMES_REAL(0) && most <= slack;
    bool between = start > GN_VOLUMES_REAL(0) ? end < GN_VOLUMES_REAL(0) : (start < GN_VOLUMES_REAL(0) && end > GN_VOLUMES_REAL(0));
    if (!through || !between) {
        return vec4(0.0f);
    }
    return vec4(float(u / sum), float(v / sum), float(w / sum), 1.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif

#endif
