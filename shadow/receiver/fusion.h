// SPDX-License-Identifier: MIT
// Names of the ways in which shadow/receiver/fusion.glsl unites occluders.
#ifndef GN_SHADOW_RECEIVER_FUSION_H
#define GN_SHADOW_RECEIVER_FUSION_H

#define GN_FUSION_SUM 0
#define GN_FUSION_MAX 1
#define GN_FUSION_MEAN 2
#define GN_FUSION_PRODUCT 3

#endif
