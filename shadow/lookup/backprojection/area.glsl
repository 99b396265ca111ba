// SPDX-License-Identifier: MIT
// How much of the light a polygon hides, by its edges: the part of the light between an edge and an axis (square) or the centre
// (disc), signed, so that edges of a closed polygon add up to what it hides.
// Based on: Guennebaud, Barthe, Paulin. High-Quality Adaptive Soft Shadow Mapping. Computer Graphics Forum 2007. [GBP07]
#ifndef GN_SHADOW_BACKPROJECTION_AREA_GLSL
#define GN_SHADOW_BACKPROJECTION_AREA_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The integral of clamp(y, -1, 1).
GN_FN float gn_back_clamped(float y) { return abs(y) <= 1.0f ? 0.5f * y * y : abs(y) - 0.5f; }

// The light is the square [-1,1]^2: the integral of clamp(y, -1, 1) over x from a to b, within the square.
GN_FN float gn_back_square_edge(vec2 a, vec2 b) {
    float from = clamp(a.x, -1.0f, 1.0f);
    float to = clamp(b.x, -1.0f, 1.0f);
    if (from == to) {
        return 0.0f;
    }
    float slope = (b.y - a.y) / (b.x - a.x);
    float y0 = a.y + (from - a.x) * slope;
    float y1 = a.y + (to - a.x) * slope;
    float mean = clamp(0.5f * (y0 + y1), -1.0f, 1.0f);
    if (abs(y1 - y0) > 1.0e-3f) {
        mean = (gn_back_clamped(y1) - gn_back_clamped(y0)) / (y1 - y0);
    }
    return (to - from) * mean;
}

GN_FN float gn_back_cross(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// The light is the unit disc: the sector from a to b outside of it, the triangle with its centre inside.
GN_FN float gn_back_disc_edge(vec2 a, vec2 b) {
    vec2 d = b - a;
    float square = dot(d, d);
    if (square == 0.0f) {
        return 0.0f;
    }
    // Where the line meets the circle: |a + t d| = 1.
    float middle = -dot(a, d) / square;
    float root = middle * middle - (dot(a, a) - 1.0f) / square;
    float half_chord = sqrt(max(root, 0.0f));
    float from = clamp(middle - half_chord, 0.0f, 1.0f);
    float to = clamp(middle + half_chord, 0.0f, 1.0f);
    vec2 p = a + from * d;
    vec2 q = a + to * d;
    float before = atan(gn_back_cross(a, p), dot(a, p) + 1.0e-30f);
    float after = atan(gn_back_cross(q, b), dot(q, b) + 1.0e-30f);
    return 0.5f * (before + gn_back_cross(p, q) + after);
}

// Against the clock for the square, with it for the disc: only the sum's size counts.
GN_FN float gn_back_edge(vec2 a, vec2 b, bool disc) {
    return disc ? gn_back_disc_edge(a, b) / 3.14159265f : -gn_back_square_edge(a, b) / 4.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
