// SPDX-License-Identifier: MIT
// Parameters of contact-hardening shadows.
#ifndef GN_SHADOW_LOOKUP_CHS_H
#define GN_SHADOW_LOOKUP_CHS_H

#include "base/shared.h"

#define GN_CHS_POINTS 0
#define GN_CHS_MEAN 1

struct GnChsParams {
    int side GN_DEFAULT(8);
    int texels GN_DEFAULT(GN_CHS_POINTS);
    int finer GN_DEFAULT(2);
    float least GN_DEFAULT(1.5f);
    int early_out GN_DEFAULT(1);
};

#endif
