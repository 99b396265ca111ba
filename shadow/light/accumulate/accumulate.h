// SPDX-License-Identifier: MIT
#ifndef GN_SHADOW_LIGHT_ACCUMULATE_H
#define GN_SHADOW_LIGHT_ACCUMULATE_H

#include "base/shared.h"

struct GnAccumulateParams {
    int lights GN_DEFAULT(64);     ///< points of the light
    int share GN_DEFAULT(1);       ///< side of the square of pixels that share the points out among them
    float error GN_DEFAULT(0.0f);  ///< above 0: what V may err by along a straight edge, instead of `lights`
};

#ifdef __cplusplus
namespace gn {

/// Points of a (0,2)-sequence that hold V behind any straight edge to `error`: the fewest 4^k of which so many hold it. They lie
/// one in each of 2^k x 2^k cells of the light, of which a straight line crosses at most 2 * 2^k - 1: the others are seen or
/// hidden as a whole, so that |V_N - V| <= (2 * 2^k - 1) / 4^k. [Mit96]
int points_within(float error);

}  // namespace gn
#endif

#endif
