// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02]
#ifndef GN_SHADOW_GEOMETRY_VOLUMES_H
#define GN_SHADOW_GEOMETRY_VOLUMES_H

#include "base/shared.h"

// How a component of the mesh casts, in the two lowest bits of its form.
#define GN_VOLUMES_ANY 0    // with every triangle, each turned to face the light [KKJ08]
#define GN_VOLUMES_FRONT 1  // with the triangles whose front faces the light
#define GN_VOLUMES_BACK 2   // with the triangles whose back faces the light
#define GN_VOLUMES_NONE 3   // not at all
// How its volumes are counted: behind the sample, where caps count, or before it (z-pass).
#define GN_VOLUMES_BEFORE 4
// Its caps are listed although it is counted before the sample: they close its volumes at the near plane (zp+).
#define GN_VOLUMES_CAPPED 8

// Where its volumes end: 0 nowhere, else 1 plus the plane's number, low x, high x, low y, ... of GnVolumesFrame.
#define GN_VOLUMES_PLANE_SHIFT 4
// Rows and columns of the picture by which volumes may be cut. A component's run of them is a uvec4: slices minus the first column,
// one plus the last, likewise rows; all 0 where no sample may be in its volumes.
#define GN_VOLUMES_SLICES 16
// Bits of a side's entry below its plane's: the edge, times 2, + 1 when turned over.
#define GN_VOLUMES_SIDE_BITS 29

// What every pass of one light knows.
struct GnVolumesFrame {
    mat4 cs_from_ws;
    vec4 eye_ws;    ///< w = 1: the eye; w = 0: the direction towards it (orthographic)
    vec4 light_ws;  ///< w = 1: a point; w = 0: the direction towards it
    uint triangles;
    uint edges;
    uint opaque_triangles;  ///< slots of the list of caps that opaque triangles have; compared ones follow
    uint most_sides;  ///< the most sides there can be: those that count before the sample are listed from this end
    float snap;       ///< pixels by which the rasterizer may move an edge
    float pixel;      ///< metres that a pixel spans at a distance of 1 m, or everywhere (orthographic)
    float reach;      ///< metres that a sun's volumes are long; 0: without end, for any light
    int capped;       ///< 1: volumes are closed at the near plane (zp+), and all count before the sample
    vec4 low_ws;      ///< corners of a box beyond which volumes may end; w = 1 where some do
    vec4 high_ws;
    int every;  ///< 1: each triangle has three sides of its own, whatever cancels (brute force)
};

#endif
