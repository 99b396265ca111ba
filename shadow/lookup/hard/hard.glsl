// SPDX-License-Identifier: MIT
// One comparison with the texel the receiver falls into.
// Based on: Williams. Casting Curved Shadows on Curved Surfaces. SIGGRAPH 1978. [Wil78]
#ifndef GN_SHADOW_LOOKUP_HARD_GLSL
#define GN_SHADOW_LOOKUP_HARD_GLSL

#include "shadow/receiver/map_access.glsl"
#include "shadow/receiver/confidence.glsl"

#ifndef __cplusplus
// Where a host draws ids, `ids` holds them; else nothing reads `ids`:
//   #define GN_CASTER_IDS
float gn_hard_visibility(GnLookup at, sampler2DArray depth, sampler2DArray ids) {
    GnProjected projected = at.projected;
    // Compare where the texel was sampled: at its centre.
    ivec2 texel = ivec2(floor(projected.uv_ts / projected.texel_ts));
    vec2 centre_ts = (vec2(texel) + 0.5) * projected.texel_ts;
    float occluder = gn_map_texel(depth, at, texel).r;
    bool lit = gn_depth_at(projected, centre_ts, at.bias) <= occluder;
#ifdef GN_CASTER_IDS
    // An object never shadows itself. [HN85]
    lit = lit || gn_map_texel(ids, at, texel).r == float(at.receiver.object);
#endif
    return lit ? 1.0 : 0.0;
}

// Metres along the view's depth from the receiver to what its texel holds; 0 where that does not hide it.
float gn_hard_blocker_distance(GnLookup at, sampler2DArray depth, sampler2DArray ids) {
    if (gn_hard_visibility(at, depth, ids) > 0.0) {
        return 0.0;
    }
    ivec2 texel = ivec2(floor(at.projected.uv_ts / at.projected.texel_ts));
    return max(at.projected.depth - gn_map_texel(depth, at, texel).r, 0.0) * at.view.metres_per_depth;
}

// How near the texel's centre lies, and how far around the sample casters change its V.
float gn_hard_confidence(GnLookup at, sampler2DArray depth, sampler2DArray ids) { return gn_confidence(at.projected); }
float gn_hard_kernel_reach(GnLookup at, sampler2DArray depth, sampler2DArray ids) { return gn_kernel_reach(at.projected, at.bias); }
#endif

#endif
