// SPDX-License-Identifier: MIT
// Based on: Wyman, Hansen. Penumbra Maps: Approximate Soft Shadows in Real-Time. EGSR 2003. [WH03]
//
// It compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_PENUMBRA_MAPS_GLSL
#define GN_SHADOW_DIRECT_PENUMBRA_MAPS_GLSL

#include "base/shared.h"

// What a texel of the penumbra map holds where a cone or a sheet covers it. The cone of a vertex at the depth z_V, or the sheet
// of an edge, is left by the ray at z_F: of a lamp where off = 1 - z_V / z_F, of a sun where off = z_F - z_V. The surface
// behind it at z_P has I = (z_F - z_V) / (z_P - z_V); beyond the cone it is lit. [WH03] section 3.2
// Depths are metres along the view, from the lamp; `off` as shadow/casters/fins.h says.
GN_FN float gn_penumbra_maps_light(float off, float vertex, float surface, bool lamp) {
    if (surface <= vertex || (lamp && off >= 1.0f)) {
        return 1.0f;
    }
    float cone = lamp ? vertex * off / (1.0f - off) : off;
    return cone >= surface - vertex ? 1.0f : cone / (surface - vertex);
}

#endif
