// SPDX-License-Identifier: MIT
// What a renderer's vertex and index buffers become: one mesh in world space, as every part reads casters. Objects that
// share a mesh get vertices of their own.
#ifndef GN_SHADOW_EMBED_LENT_CASTERS_GLSL
#define GN_SHADOW_EMBED_LENT_CASTERS_GLSL

#include "base/shared.h"

// An object in the renderer's buffers, and where what it becomes begins.
struct GnLentObject {
    uint first_index;
    uint first_vertex;
    uint vertex_count;
    uint transform;
    uint out_index;   // objects lie behind each other, in ascending order
    uint out_vertex;
};

#endif
