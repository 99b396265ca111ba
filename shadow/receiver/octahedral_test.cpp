// SPDX-License-Identifier: MIT
// Unit vectors as points of an unfolded octahedron.
#include "shadow/receiver/octahedral.glsl"

#include <gtest/gtest.h>

#include <random>

namespace gn::octahedral_test {
namespace {

TEST(Octahedral, ADirectionComesBackAlsoFromThirtyTwoBits) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::size_t below = 0;
    float packed_error = 0;
    for (int i = 0; i < 1000; ++i) {
        const vec3 n = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        // The length of what is mapped does not matter.
        EXPECT_LT(glm::length(glsl::gn_from_octahedral(glsl::gn_to_octahedral(n * 3.0F)) - n), 1e-6F)
            << n.x << ' ' << n.y << ' ' << n.z;
        packed_error = std::max(packed_error, glm::length(glsl::gn_unpack_direction(glsl::gn_pack_direction(n)) - n));
        below += n.z < 0 ? 1 : 0;
    }
    EXPECT_GT(below, 300U);
    EXPECT_LT(packed_error, 1e-4F);
    EXPECT_GT(packed_error, 1e-6F);
}

/// [MSS10]: the upper half lies within the diamond as seen from above, the lower is folded over the square's corners.
TEST(Octahedral, HalvesLieWhereThePaperDrawsThem) {
    EXPECT_EQ(glsl::gn_to_octahedral(vec3(0, 0, 1)), vec2(0, 0));
    EXPECT_EQ(glsl::gn_to_octahedral(vec3(0, 2, 0)), vec2(0, 1));
    EXPECT_EQ(glsl::gn_to_octahedral(vec3(1, -1, -2)), vec2(0.75F, -0.75F));
}

}  // namespace
}  // namespace gn::octahedral_test
