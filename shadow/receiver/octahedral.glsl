// SPDX-License-Identifier: MIT
// Unit vectors as points of a square: the octahedron around them, unfolded. Compiles as GLSL and as C++.
// Based on: Meyer, Suessmuth, Sussner, Stamminger, Greiner. On Floating-Point Normal Vectors. EGSR 2010. [MSS10]
#ifndef GN_SHADOW_RECEIVER_OCTAHEDRAL_GLSL
#define GN_SHADOW_RECEIVER_OCTAHEDRAL_GLSL

#include "base/shared.h"

#ifdef __cplusplus
#include <glm/packing.hpp>
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

// The point of the map, in [-1,1] each, of a vector that is not zero, of any length.
GN_FN vec2 gn_to_octahedral(vec3 n) {
    vec2 e = vec2(n.x, n.y) / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z >= 0.0f) {
        return e;
    }
    return vec2((1.0f - abs(e.y)) * (e.x >= 0.0f ? 1.0f : -1.0f), (1.0f - abs(e.x)) * (e.y >= 0.0f ? 1.0f : -1.0f));
}

// The same in 32 bits: as far from the vector as 1e-4 radians at most.
GN_FN uint gn_pack_direction(vec3 n) {
    return packSnorm2x16(gn_to_octahedral(n));
}
GN_FN vec3 gn_unpack_direction(uint packed_direction) {
    return gn_from_octahedral(unpackSnorm2x16(packed_direction));
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
