// SPDX-License-Identifier: MIT
// Parameters that every blurred and mipmapped map has: a member `prefilter` of the map's own struct.
#ifndef GN_SHADOW_MAP_PREFILTER_PARAMS_H
#define GN_SHADOW_MAP_PREFILTER_PARAMS_H

#include "base/shared.h"

#define GN_BLUR_NONE 0
#define GN_BLUR_BOX 1
#define GN_BLUR_GAUSSIAN 2

struct GnPrefilterParams {
    int blur GN_DEFAULT(GN_BLUR_BOX);
    int radius GN_DEFAULT(2);
    int mipmaps GN_DEFAULT(1);
    int anisotropy GN_DEFAULT(1);
};

#endif
