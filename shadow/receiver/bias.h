// SPDX-License-Identifier: MIT
// The bias of every map recipe: orthogonal parameters, `bias.*` in recipes. See docs/bias.md.
#ifndef GN_SHADOW_BIAS_H
#define GN_SHADOW_BIAS_H

#include "base/shared.h"

struct GnBias {
    float constant GN_DEFAULT(0.5f);        ///< texels towards the light
    float constant_world GN_DEFAULT(0.0f);  ///< metres towards the light
    float slope GN_DEFAULT(0.0f);           ///< texels towards the light per unit of tan(angle of incidence)
    float slope_max GN_DEFAULT(16.0f);      ///< limit of that tangent
    float normal GN_DEFAULT(0.25f);         ///< texels along the normal, scaled by the sine of the angle of incidence
    float normal_world GN_DEFAULT(0.0f);    ///< metres along the normal, likewise
    int receiver_plane GN_DEFAULT(1);       ///< 1: taps compare with the receiver's plane, not with one depth
    float cone GN_DEFAULT(2.0f);            ///< texels towards the light per texel between a tap and the receiver; with
                                            ///< receiver_plane, per texel to where the plane falls away from the light
    float view GN_DEFAULT(0.0f);            ///< texels towards the camera
    float view_world GN_DEFAULT(0.0f);      ///< metres towards the camera
    float kernel GN_DEFAULT(1.0f);  ///< without receiver_plane: share of the kernel's reach that the texels grow by
    float dual GN_DEFAULT(8.0f);    ///< casters = dual: texels that the stored depth lies behind the nearest at most
    float dual_world GN_DEFAULT(0.0f);  ///< metres, likewise; added

    // No parameters: how far the recipe's kernels reach, which the passes that apply a bias fill in.
    float reach GN_DEFAULT(0.0f);         ///< texels
    float reach_world GN_DEFAULT(0.0f);   ///< metres
    float reach_pixels GN_DEFAULT(0.0f);  ///< pixels of the picture
};

#endif
