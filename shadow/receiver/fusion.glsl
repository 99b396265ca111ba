// SPDX-License-Identifier: MIT
// What several occluders hide of the light together, where only the share that each hides is known. Between the greatest and the sum
// lies the truth: max B_i <= B <= sum B_i. Compiles as GLSL and as C++.
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09], 1.3, eq. 1.5.
#ifndef GN_SHADOW_RECEIVER_FUSION_GLSL
#define GN_SHADOW_RECEIVER_FUSION_GLSL

#include "base/shared.h"
#include "shadow/receiver/fusion.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

struct GnFused {
    float sum;
    float most;
    float left;  // the product of what each leaves
};

GN_FN GnFused gn_unfused() {
    GnFused fused;
    fused.sum = 0.0f;
    fused.most = 0.0f;
    fused.left = 1.0f;
    return fused;
}

// One more, that hides this share.
GN_FN GnFused gn_fuse(GnFused fused, float hidden) {
    fused.sum += hidden;
    fused.most = max(fused.most, hidden);
    fused.left *= 1.0f - hidden;
    return fused;
}

// The share that all hide: their sum, if they are apart; the greatest, if one covers the others; the middle between these two; or
// the product of what they leave, if they are independent.
GN_FN float gn_fused(GnFused fused, int fusion) {
    float sum = min(fused.sum, 1.0f);
    if (fusion == GN_FUSION_SUM) {
        return sum;
    }
    if (fusion == GN_FUSION_MEAN) {
        return 0.5f * (fused.most + sum);
    }
    return fusion == GN_FUSION_PRODUCT ? 1.0f - fused.left : fused.most;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
