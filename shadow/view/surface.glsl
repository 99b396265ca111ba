// SPDX-License-Identifier: MIT
// What a view sample knows of its surface besides its place, plane and colour, in 64 bits: the interpolated normal, and the
// object's index above eight bits of roughness. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_VIEW_SURFACE_GLSL
#define GN_SHADOW_VIEW_SURFACE_GLSL

#include "shadow/receiver/octahedral.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Indices that fit; a scene of more objects is refused where it is brought to the GPU.
const uint gn_surface_objects = 1u << 24;

GN_FN uvec2 gn_surface(vec3 n_ws, uint object, float roughness) {
    return uvec2(gn_pack_direction(n_ws), (object << 8) | uint(clamp(roughness, 0.0f, 1.0f) * 255.0f + 0.5f));
}
GN_FN vec3 gn_surface_normal(uvec2 surface) {
    return gn_unpack_direction(surface.x);
}
GN_FN uint gn_surface_object(uvec2 surface) {
    return surface.y >> 8;
}
GN_FN float gn_surface_roughness(uvec2 surface) {
    return float(surface.y & 255u) / 255.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
