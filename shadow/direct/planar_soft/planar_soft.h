// SPDX-License-Identifier: MIT
// Based on: Heckbert, Herf. Simulating Soft Shadows with Graphics Hardware. CMU-CS-97-104, 1997. [HH97]
#ifndef GN_SHADOW_DIRECT_PLANAR_SOFT_H
#define GN_SHADOW_DIRECT_PLANAR_SOFT_H

#include "base/shared.h"

#define GN_PLANAR_SOFT_ACCUMULATE 0
#define GN_PLANAR_SOFT_BLUR 1

struct GnPlanarSoftParams {
    int mode GN_DEFAULT(GN_PLANAR_SOFT_ACCUMULATE);
    int samples GN_DEFAULT(64);           ///< accumulate: points of the light
    float height GN_DEFAULT(0.5f);        ///< blur: of the casters' height, where its width is right
    int texels GN_DEFAULT(512);           ///< blur: along a side of a plane's picture
    int planes GN_DEFAULT(4);             ///< most receiver planes
    float min_area GN_DEFAULT(0.02f);     ///< of the scene's surface that a plane must hold
    float tolerance GN_DEFAULT(1.0e-5f);  ///< of the scene's diagonal that a plane may be thick
};

// A plane's picture: where a point of the plane lies in it, texture coordinates by dot products with (p_ws, 1), and its layer.
struct GnPlanarSoftPicture {
    vec4 plane_ws;
    vec4 u_from_ws;
    vec4 v_from_ws;
};

#endif
