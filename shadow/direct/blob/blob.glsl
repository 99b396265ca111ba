// SPDX-License-Identifier: MIT
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, chapter 7. 2018. [AHH18]
//
// A disc in place of a caster; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_BLOB_GLSL
#define GN_SHADOW_DIRECT_BLOB_GLSL

#include "shadow/direct/blob/blob.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Radius of the disc that has the area of a box's shadow along a unit direction: each pair of faces shows its area times the
// cosine of its normal.
GN_FN float gn_blob_radius(vec3 low_ws, vec3 high_ws, vec3 along_ws) {
    vec3 size = high_ws - low_ws;
    float area = abs(along_ws.x) * size.y * size.z + abs(along_ws.y) * size.x * size.z + abs(along_ws.z) * size.x * size.y;
    return sqrt(area / 3.14159265f);
}

// What a disc hides `x` of its radius away from its middle: a ramp from 1 to 0. A disc of the ramp's middle radius k hides
// pi k^2 (1 + softness^2 / 3) in all, so that k is chosen to keep pi whatever the softness.
GN_FN float gn_blob_profile(float x, float softness) {
    float k = 1.0f / sqrt(1.0f + softness * softness / 3.0f);
    float half_width = max(k * softness, 1.0e-4f);
    return clamp((k + half_width - x) / (2.0f * half_width), 0.0f, 1.0f);
}

// What the blob hides from a point: nothing within the caster's bounds and before its middle.
GN_FN float gn_blob_hidden(GnBlob blob, vec3 p_ws, GnBlobParams params) {
    vec3 from_centre = p_ws - vec3(blob.centre_ws);
    vec3 axis_ws = vec3(blob.axis_ws);
    float beyond = dot(from_centre, axis_ws);
    float radius = blob.centre_ws.w * params.size * (1.0f + beyond * blob.axis_ws.w);
    vec3 across = from_centre - axis_ws * beyond;
    float off2 = dot(across, across);
    // Ramps end before twice the radius.
    if (beyond <= 0.0f || off2 >= 4.0f * radius * radius) {
        return 0.0f;
    }
    vec3 low = vec3(blob.low_ws);
    vec3 high = vec3(blob.high_ws);
    // A thousandth of the bounds covers the rounding of surfaces that lie in their faces.
    float skin = 1.0e-3f * length(high - low);
    vec3 outside = max(low - p_ws, p_ws - high);
    bool within = max(outside.x, max(outside.y, outside.z)) <= skin;
    return within ? 0.0f : params.opacity * gn_blob_profile(sqrt(off2) / radius, params.softness);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
