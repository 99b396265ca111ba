// SPDX-License-Identifier: MIT
// Parameters of soft shadows from prefiltered maps.
#ifndef GN_SHADOW_LOOKUP_VSSM_H
#define GN_SHADOW_LOOKUP_VSSM_H

#include "base/shared.h"

struct GnVssmParams {
    int side GN_DEFAULT(3);
    float least GN_DEFAULT(1.5f);
    int early_out GN_DEFAULT(1);
};

#endif
