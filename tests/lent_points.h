// SPDX-License-Identifier: MIT
// V of points that a test chooses: a renderer's own receivers, wherever they lie.
#pragma once

#include "tests/rig.h"

namespace gn::test {

struct LentPoint {
    vec3 p_ws{0}, n_ws{0, 1, 0};
};
/// V of the scene's first light at each of the points, by one frame of the recipe. `remarks` takes what it said.
std::vector<float> visibility_at(const Scene& scene, const std::string& recipe, std::span<const LentPoint> points,
                                 std::set<std::string>* remarks = nullptr);

}  // namespace gn::test
