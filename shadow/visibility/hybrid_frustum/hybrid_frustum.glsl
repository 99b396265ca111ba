// SPDX-License-Identifier: MIT
// Based on: Story, Wyman. HFTS: Hybrid Frustum-Traced Shadows in "The Division". SIGGRAPH Talks 2016. [SW16]
//
// What the soft shadow weighs. Compiles as GLSL and as C++.
#ifndef GN_SHADOW_VISIBILITY_HYBRID_FRUSTUM_GLSL
#define GN_SHADOW_VISIBILITY_HYBRID_FRUSTUM_GLSL

#include "shadow/visibility/hybrid_frustum/hybrid_frustum.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// 0 where the penumbra, `pixels` across, is narrow, 1 where it is wide. Its width is the occluder's distance times what the
// light's size and place make of it.
GN_FN float gn_hybrid_frustum_weight(float pixels, GnHybridFrustumParams params) {
    if (params.by != GN_HYBRID_FRUSTUM_DISTANCE) {
        return params.by == GN_HYBRID_FRUSTUM_SOFT ? 1.0f : 0.0f;
    }
    return clamp((pixels - params.narrow) / max(params.wide - params.narrow, 1.0e-3f), 0.0f, 1.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
