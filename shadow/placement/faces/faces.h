// SPDX-License-Identifier: MIT
// Parameters of a map for each face of the camera's frustum, and what the choice of a face is given.
#ifndef GN_SHADOW_PLACEMENT_FRUSTUM_FACES_H
#define GN_SHADOW_PLACEMENT_FRUSTUM_FACES_H

#include "base/shared.h"

#define GN_FRUSTUM_FACES 6

#define GN_FACES_AUTO 0
#define GN_FACES_BACK 1
#define GN_FACES_FRONT 2

#define GN_FACES_NO_WARP 0
#define GN_FACES_PERSPECTIVE 1

struct GnFacesParams {
    int side GN_DEFAULT(GN_FACES_AUTO);
    int warp GN_DEFAULT(GN_FACES_PERSPECTIVE);
    float near GN_DEFAULT(0.005f);  ///< of the farthest depth: receivers nearer than this do not steer the warps
};

/// What the choice of a face is given.
struct GnFrustumFaces {
    /// Of each face, in the order of gn::frustum_planes: its key at p_ws is dot(keys_ws, (p_ws, 1)), the distance to its plane
    /// over what the light is away from it (of the sun: over the sine between its rays and the plane). The ray through p_ws
    /// meets the face with the least key first.
    vec4 keys_ws[GN_FRUSTUM_FACES] GN_DEFAULT({});
    vec4 eye_ws GN_DEFAULT(vec4(0));  ///< the light's place; w = 1 where the views are the six faces around it instead
};

#endif
