// SPDX-License-Identifier: MIT
// Lights that show pictures, and what rays to their points say of them.
#pragma once

#include "tests/rig.h"

namespace gn::test {

/// A picture whose left half is red and whose right half is blue; green grows from its upper edge to its lower.
Texture red_and_blue(int side = 64);
/// Lets the scene's first light, a rectangle, show it.
void show_picture(Scene& scene, Texture picture);

/// V of three channels of the scene's first light: of each of light_samples(light, count, side) the truth's ray says whether it is
/// seen, and it weighs what emission_of_points says.
struct TracedPicture {
    std::vector<vec3> visibility;       ///< one a sample; 0 where it does not count
    std::vector<std::uint8_t> counted;  ///< one a sample
    int coloured = 0;                   ///< samples whose red and blue differ by more than a quarter
};
TracedPicture trace_picture(const Scene& scene, const CpuSamples& samples, int count, int side = 1);

}  // namespace gn::test
