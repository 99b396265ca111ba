// SPDX-License-Identifier: MIT
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, chapter 7. 2018. [AHH18]
#ifndef GN_SHADOW_DIRECT_BLOB_H
#define GN_SHADOW_DIRECT_BLOB_H

#include "base/shared.h"

struct GnBlobParams {
    float softness GN_DEFAULT(0.5f);  ///< half of the ramp's width, of the disc's radius
    float size GN_DEFAULT(1.0f);      ///< times the radius of the disc that has the area of the bounds' shadow
    float opacity GN_DEFAULT(1.0f);   ///< what the middle of a disc hides
};

// A caster as its disc knows it.
struct GnBlob {
    vec4 centre_ws;  ///< w: the disc's radius across the light, metres
    vec4 axis_ws;    ///< unit, away from the light; w: by how much of itself the disc grows a metre along it
    vec4 low_ws;     ///< its bounds
    vec4 high_ws;
};

#endif
