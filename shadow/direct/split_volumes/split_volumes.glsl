// SPDX-License-Identifier: MIT
// Based on: Laine. Split-plane Shadow Volumes. Graphics Hardware 2005. [Lai05]
#ifndef GN_SHADOW_DIRECT_SPLIT_VOLUMES_GLSL
#define GN_SHADOW_DIRECT_SPLIT_VOLUMES_GLSL

#include "base/shared.h"
#include "shadow/direct/split_volumes/split_volumes.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The splitting depth of a tile from its nearest and its farthest sample, in the camera's depth, which is reversed: as many
// times nearer than the one as farther than the other.
GN_FN float gn_split_volumes_depth(float nearest, float farthest) {
    return sqrt(nearest * farthest);
}

// One bit of a pixel's place, as good as chance.
GN_FN bool gn_split_volumes_coin(ivec2 pixel) {
    uint h = uint(pixel.x) * 0x9E3779B9u ^ uint(pixel.y) * 0x85EBCA6Bu;
    h = (h ^ (h >> 15)) * 0xC2B2AE35u;
    return ((h >> 16) & 1u) != 0u;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif

#endif
