// SPDX-License-Identifier: MIT
// Soft shadows by rays through the map, to as many points of the light for each sample.
// Based on: Agrawala, Ramamoorthi, Heirich, Moll. Efficient Image-Based Methods for Rendering Soft Shadows. SIGGRAPH 2000. [ARHM00]
#ifndef GN_SHADOW_LOOKUP_SMRT_GLSL
#define GN_SHADOW_LOOKUP_SMRT_GLSL

#include "shadow/lookup/smrt/rays.glsl"
#include "shadow/receiver/confidence.glsl"

#ifndef __cplusplus
float gn_smrt_noise(GnLookup at, GnSmrtParams params) {
    if (params.noise == GN_SMRT_OF_PIXEL) {
        return gn_gradient_noise(at.receiver.p_ss);
    }
    vec2 texel = floor(at.projected.uv_ts / at.projected.texel_ts);
    return gn_gradient_noise(texel + 0.5 + 5.588238 * float(at.projected.layer));
}

float gn_smrt_visibility(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnSmrtParams params) {
    GnExtentLight half_light = gn_smrt_light(at.light, at.receiver.p_ws);
    GnExtentMetres metres = gn_extent_metres_of(at);
    GnExtentRegion region = gn_extent_region(at, pyramid, half_light, metres, params.least, true);
    if (region.visibility == 1.0) {
        return 1.0;
    }
    return gn_smrt_share(at, depth, half_light, region.spread, params, gn_smrt_noise(at, params));
}

// How near the texel's centre lies, and how far around the sample casters change its V.
float gn_smrt_confidence(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnSmrtParams params) { return gn_confidence(at.projected); }
float gn_smrt_kernel_reach(GnLookup at, sampler2DArray depth, sampler2DArray pyramid, GnSmrtParams params) { return gn_kernel_reach(at.projected, at.bias); }
#endif

#endif
