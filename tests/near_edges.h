// SPDX-License-Identifier: MIT
// How near a view sample lies to what the rasterizer's rounding can change. Samples of a picture miss what is narrower than a
// pixel: the edge of a shadow that two neighbours do not tell lies beside them all the same.
#pragma once

#include "tests/rig.h"

namespace gn::test {

/// Pixels, from 1/1024 to 1 by steps of a fifth, at which a point of the sample's plane has another traced V than `traced`, or does not
/// count; infinite where none has. The light is a point: one ray decides.
float pixels_to_shadow(const Truth& truth, const Scene& scene, const CpuSamples& samples, std::size_t i,
                       const GnLight& light, float traced);

/// Pixels from the sample's centre to the nearest edge of a triangle in the picture, whatever hides it.
float pixels_to_triangle(const Scene& scene, const CpuSamples& samples, std::size_t i);

}  // namespace gn::test
