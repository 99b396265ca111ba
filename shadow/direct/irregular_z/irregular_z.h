// SPDX-License-Identifier: MIT
// Parameters of the irregular z-buffer.
#ifndef GN_SHADOW_DIRECT_IRREGULAR_Z_H
#define GN_SHADOW_DIRECT_IRREGULAR_Z_H

#include "base/shared.h"

#define GN_IRREGULAR_SAMPLES 0
#define GN_IRREGULAR_TRIANGLES 1

struct GnIrregularZParams {
    int lists GN_DEFAULT(GN_IRREGULAR_SAMPLES);  ///< what a texel lists: view samples, or triangles
};

#endif
