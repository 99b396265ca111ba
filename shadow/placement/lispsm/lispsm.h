// SPDX-License-Identifier: MIT
// Parameters of light space perspective shadow maps.
#ifndef GN_SHADOW_PLACEMENT_LISPSM_H
#define GN_SHADOW_PLACEMENT_LISPSM_H

#include "base/shared.h"

#define GN_LISPSM_LLOYD 0
#define GN_LISPSM_WSP04 1

struct GnLispsmParams {
    int falloff GN_DEFAULT(GN_LISPSM_LLOYD);
    float near GN_DEFAULT(0.005f);  ///< of the farthest depth: receivers nearer than this do not steer the warp
    float eta GN_DEFAULT(0.0f);     ///< strength where view and light are perpendicular: -1 uniform, 0 even error along
                                    ///< the view, 1 even error across it
};

#endif
