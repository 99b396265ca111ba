// SPDX-License-Identifier: MIT
// Based on: Chan, Durand. An Efficient Hybrid Shadow Rendering Algorithm. EGSR 2004. [CD04]
#ifndef GN_SHADOW_DIRECT_HYBRID_VOLUMES_GLSL
#define GN_SHADOW_DIRECT_HYBRID_VOLUMES_GLSL

#include "shadow/direct/hybrid_volumes/hybrid_volumes.h"
#include "shadow/receiver/receiver.glsl"

// What the map cannot tell: the sample lies at a discontinuity.
#define GN_HYBRID_VOLUMES_UNKNOWN 2.0

#ifndef __cplusplus
// V by the map where the texels around a sample agree, 2 band by 2 band of them; else, and beyond the view, unknown. [CD04] 3.1
float gn_hybrid_volumes_seen(GnProjected projected, sampler2DArray depth, GnBias bias, int band) {
    ivec2 first = ivec2(floor(projected.uv_ts / projected.texel_ts - 0.5)) - (band - 1);
    vec2 low_ts = vec2(first) * projected.texel_ts, high_ts = vec2(first + 2 * band) * projected.texel_ts;
    if (!projected.inside || any(lessThan(low_ts, projected.bounds_ts.xy)) ||
        any(greaterThan(high_ts, projected.bounds_ts.zw))) {
        return GN_HYBRID_VOLUMES_UNKNOWN;
    }
    int lit = 0;
    for (int i = 0; i < 4 * band * band; ++i) {
        ivec2 texel = first + ivec2(i % (2 * band), i / (2 * band));
        float plane = gn_depth_at(projected, (vec2(texel) + 0.5) * projected.texel_ts, bias);
        lit += plane <= texelFetch(depth, ivec3(texel, projected.layer), 0).r ? 1 : 0;
    }
    return lit == 0 ? 0.0 : lit == 4 * band * band ? 1.0 : GN_HYBRID_VOLUMES_UNKNOWN;
}
#endif

#endif
