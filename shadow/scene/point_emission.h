// SPDX-License-Identifier: MIT
// What each of some points of a light stands for of the picture that the light shows.
// Based on: Eisemann, Decoret. Visibility Sampling on GPU and Applications. Eurographics 2007. [ED07]
// Departs from it: every point has a colour of its own, where they sum points of one colour by their number.
#pragma once

#include "shadow/scene/emission.h"

#include <vector>

namespace gn {

/// For each of light_samples(light, count, side): the mean of the picture over what is nearer to the point, on the light's square,
/// than to any other that the same pixel takes. Linear rgb, w = 0. Of a colour that the picture lacks all are 1: points count alike.
std::vector<vec4> emission_of_points(const Image8& picture, const GnLight& light, int count, int side = 1);

}  // namespace gn
