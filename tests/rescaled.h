// SPDX-License-Identifier: MIT
// The same scene larger or smaller, or in the company of a triangle that strayed far away.
#pragma once

#include "tests/rig.h"

namespace gn::test {

/// The box that stands on the ground, under one light of a kind: "directional", "spot", "point" or "rectangle".
Scene lit_scene(const std::string& kind);

/// Every length of the scene times `scale`. Light that falls on it stays: candela grow with the square.
Scene rescaled(Scene scene, float scale);

/// One triangle of the size of a hand, an object of its own or the last one's.
Scene with_stray(Scene scene, vec3 at_ws, bool own_object);

/// V of the first light for every view sample; empty where the recipe refuses the light.
std::vector<float> visibility_of(const Scene& scene, const std::string& recipe, uint size);

/// How many samples' V differ by more than `slack`.
std::size_t count_differing(const std::vector<float>& a, const std::vector<float>& b, float slack);

}  // namespace gn::test
