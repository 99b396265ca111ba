// SPDX-License-Identifier: MIT
// A point on the camera's screen, to the last bit the same in every shader that draws it: volumes' caps lie in the surfaces
// that the view has drawn, and compilers fuse or reorder a matrix's products as each shader invites them to.
#ifndef GN_SHADOW_VIEW_PROJECT_GLSL
#define GN_SHADOW_VIEW_PROJECT_GLSL

#include "base/shared.h"

vec4 gn_view_position(mat4 cs_from_ws, vec4 p_ws) {
    precise vec4 p_cs = cs_from_ws[3] * p_ws.w + cs_from_ws[2] * p_ws.z + cs_from_ws[1] * p_ws.y + cs_from_ws[0] * p_ws.x;
    return p_cs;
}

#endif
