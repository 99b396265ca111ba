// SPDX-License-Identifier: MIT
// Based on: Segal, Korobkin, van Widenfelt, Foran, Haeberli. Fast Shadows and Lighting Effects Using Texture Mapping. SIGGRAPH
// 1992. [SKB92]
//
// The black picture of the occluders, magnified; it compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_PROJECTIVE_TEXTURE_GLSL
#define GN_SHADOW_DIRECT_PROJECTIVE_TEXTURE_GLSL

#include "base/shared.h"

// The bilinear mean of four texels, which are black where an occluder was drawn: `depths` of (0,0), (1,0), (0,1), (1,1), 1 where
// none was; `at` the place between their centres.
GN_FN float gn_projective_texture_light(vec4 depths, vec2 at) {
    vec4 white = vec4(depths.x < 1.0f ? 0.0f : 1.0f, depths.y < 1.0f ? 0.0f : 1.0f, depths.z < 1.0f ? 0.0f : 1.0f,
                      depths.w < 1.0f ? 0.0f : 1.0f);
    float low = white.x + (white.y - white.x) * at.x;
    float high = white.z + (white.w - white.z) * at.x;
    return low + (high - low) * at.y;
}

#endif
