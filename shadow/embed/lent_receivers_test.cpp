// SPDX-License-Identifier: MIT
// Unpacking a renderer's normals.
#include "base/math.h"
#include "base/shared.h"

#include "shadow/embed/lent_receivers.glsl"

#include <gtest/gtest.h>

#include <random>

namespace gn::embed {
namespace {

/// [MSS10]: onto the octahedron, and its lower half folded over the upper's corners.
vec2 to_octahedral(vec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (n.z >= 0) {
        return {n.x, n.y};
    }
    return {std::copysign(1 - std::abs(n.y), n.x), std::copysign(1 - std::abs(n.x), n.y)};
}

TEST(LentReceivers, AnOctahedralNormalComesBack) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::size_t below = 0;
    for (int i = 0; i < 1000; ++i) {
        const vec3 n = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        EXPECT_LT(glm::length(glsl::gn_from_octahedral(to_octahedral(n)) - n), 1e-5F)
            << n.x << ' ' << n.y << ' ' << n.z;
        below += n.z < 0 ? 1 : 0;
    }
    EXPECT_GT(below, 300U);
}

}  // namespace
}  // namespace gn::embed
