// SPDX-License-Identifier: MIT
// Parameters of occlusion textures.
#ifndef GN_SHADOW_LOOKUP_OCCLUSION_TEXTURES_H
#define GN_SHADOW_LOOKUP_OCCLUSION_TEXTURES_H

#include "base/shared.h"
#include "shadow/receiver/fusion.h"

#define GN_OCCLUSION_N_BUFFERS 0
#define GN_OCCLUSION_SUMS 1
#define GN_OCCLUSION_MIPS 2

struct GnOcclusionTexturesParams {
    int slices GN_DEFAULT(8);
    int filter_by GN_DEFAULT(GN_OCCLUSION_N_BUFFERS);
    int cells GN_DEFAULT(3);
    int fusion GN_DEFAULT(GN_FUSION_PRODUCT);
};

#endif
