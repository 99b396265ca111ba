// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02]
#ifndef GN_SHADOW_DIRECT_VOLUMES_H
#define GN_SHADOW_DIRECT_VOLUMES_H

#include "base/shared.h"

#define GN_VOLUMES_OPAQUE 0
#define GN_VOLUMES_SKIP 1

struct GnVolumesParams {
    int masked GN_DEFAULT(GN_VOLUMES_OPAQUE);  ///< alpha-masked casters: whole polygons, or nothing
    int closed GN_DEFAULT(1);                  ///< 1: a solid casts with one side of its surface only
    int culling GN_DEFAULT(1);                 ///< 1: components whose shadow cannot be seen are left out
};

// How a component of the mesh casts.
#define GN_VOLUMES_ANY 0    // with every triangle, each turned to face the light [KKJ08]
#define GN_VOLUMES_FRONT 1  // with the triangles whose front faces the light
#define GN_VOLUMES_BACK 2   // with the triangles whose back faces the light
#define GN_VOLUMES_NONE 3   // not at all

// What every pass of one light knows.
struct GnVolumesFrame {
    mat4 cs_from_ws;
    vec4 eye_ws;    ///< w = 1: the eye; w = 0: the direction towards it (orthographic)
    vec4 light_ws;  ///< w = 1: a point; w = 0: the direction towards it
    uint triangles;
    uint edges;
    uint opaque_triangles;  ///< slots of the list of caps that opaque triangles have; masked ones follow
    float snap;             ///< pixels by which the rasterizer may move an edge
    float pixel;            ///< metres that a pixel spans at a distance of 1 m, or everywhere (orthographic)
    float reach;            ///< metres that a sun's volumes are long; 0: without end, for any light
};

#endif
