// SPDX-License-Identifier: MIT
// A lookup that a test spells out texel by texel, run in the place of a recipe's own over the very same map.
#pragma once

#include "tests/rig.h"

namespace gn::test {

/// V of the first light at every pixel of a square picture, one sample a pixel.
std::vector<float> visibility_of(const Scene& scene, const Recipe& recipe, uint pixels);

/// A lookup over depth whose GLSL function's body is given; it has `at`, `depth` and `lit(texel)`, which compares with one
/// texel at its middle. The last one made is the only one to use.
Part lookup_by_hand(const std::string& body);

/// The same as visibility_of by such a lookup. The guard stays the recipe's own, and so does the map.
std::vector<float> visibility_by_hand(const Scene& scene, Recipe recipe, const std::string& body, uint pixels);

}  // namespace gn::test
