// SPDX-License-Identifier: MIT
// Based on: Segal, Korobkin, van Widenfelt, Foran, Haeberli. Fast Shadows and Lighting Effects Using Texture Mapping. SIGGRAPH
// 1992. [SKB92]
#ifndef GN_SHADOW_DIRECT_PROJECTIVE_TEXTURE_H
#define GN_SHADOW_DIRECT_PROJECTIVE_TEXTURE_H

#include "base/shared.h"

struct GnProjectiveTextureParams {
    float flat_share GN_DEFAULT(0.5f);    ///< of an object that lies in one receiver plane: above it receives
    int planes GN_DEFAULT(16);            ///< most receiver planes
    float min_area GN_DEFAULT(0.02f);     ///< of the scene's surface that a plane must hold
    float tolerance GN_DEFAULT(1.0e-5f);  ///< of the scene's diagonal that a plane may be thick
};

#endif
