// SPDX-License-Identifier: MIT
// Unpacking of a renderer's normals.
// Based on: Meyer, Suessmuth, Sussner, Stamminger, Greiner. On Floating-Point Normal Vectors. EGSR 2010. [MSS10]
#ifndef GN_SHADOW_EMBED_LENT_RECEIVERS_GLSL
#define GN_SHADOW_EMBED_LENT_RECEIVERS_GLSL

#include "base/shared.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The unit vector of a point of the octahedron's map, in [-1,1] each.
GN_FN vec3 gn_from_octahedral(vec2 e) {
    vec3 n = vec3(e.x, e.y, 1.0f - abs(e.x) - abs(e.y));
    float fold = max(-n.z, 0.0f);
    n.x += n.x >= 0.0f ? -fold : fold;
    n.y += n.y >= 0.0f ? -fold : fold;
    return normalize(n);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
