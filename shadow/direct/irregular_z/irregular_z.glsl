// SPDX-License-Identifier: MIT
// Based on: Johnson, Lee, Burns, Mark. The Irregular Z-Buffer: Hardware Acceleration for Irregular Data Structures. ACM TOG 2005.
// [JLBM05]
//
// The texel of a light view that lists a view sample. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_IRREGULAR_Z_GLSL
#define GN_SHADOW_DIRECT_IRREGULAR_Z_GLSL

#include "shadow/casters/conservative.glsl"
#include "shadow/casters/tiles.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Where the view lists what it sees at p, x and y in texels and the layer; z = -1 where p lies behind the light. What
// rounding carries over the border of the view stays in the view.
GN_FN ivec3 gn_irregular_z_texel(GnLightView view, vec3 p_ws) {
    vec3 at = gn_texel_position(view, gn_clip(view, p_ws));
    if (!(at.z > 0.0f)) {
        return ivec3(0, 0, -1);
    }
    ivec4 own = gn_tile_texels(view);
    vec2 low = vec2(float(own.x), float(own.y));
    vec2 high = vec2(float(own.z), float(own.w));
    vec2 texel = clamp(floor(vec2(at.x, at.y) / at.z), low, high);
    return ivec3(int(texel.x), int(texel.y), view.layer);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
