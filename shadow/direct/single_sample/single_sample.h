// SPDX-License-Identifier: MIT
// Based on: Parker, Shirley, Smits. Single Sample Soft Shadows. University of Utah, UUCS-98-019, 1998. [PSS98]
#ifndef GN_SHADOW_DIRECT_SINGLE_SAMPLE_H
#define GN_SHADOW_DIRECT_SINGLE_SAMPLE_H

#include "base/shared.h"

#define GN_SINGLE_SAMPLE_SINE 0
#define GN_SINGLE_SAMPLE_CUBIC 1

struct GnSingleSampleParams {
    int profile GN_DEFAULT(GN_SINGLE_SAMPLE_CUBIC);
    int closed GN_DEFAULT(1);  ///< 1: a solid casts with one side of its surface only
};

#endif
