// SPDX-License-Identifier: MIT
// How a summed-area table is stored and made.
#ifndef GN_SHADOW_MAP_SUMS_PARAMS_H
#define GN_SHADOW_MAP_SUMS_PARAMS_H

#define GN_SAT_FLOAT32 0
#define GN_SAT_UINT32 1
#define GN_SAT_SCAN_AUTO 0
#define GN_SAT_SCAN_SERIAL 1
#define GN_SAT_SCAN_SHARED 2

#endif
