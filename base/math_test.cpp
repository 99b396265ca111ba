// SPDX-License-Identifier: MIT
#include "base/math.h"

#include <gtest/gtest.h>

#include <random>

namespace gn::math_test {
namespace {

TEST(CompleteFrame, IsUnitOrthogonalAndRightHandedInEveryDirection) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 1000; ++i) {
        // Every tenth lies along or almost against an axis, where frames like to break.
        vec3 n(normal(random), normal(random), normal(random));
        if (i % 10 == 0) {
            n = vec3(1e-7F * n.x, 0, i % 20 == 0 ? -1 : 1);
        }
        n = glm::normalize(n);
        vec3 x;
        vec3 y;
        complete_frame(n, x, y);
        ASSERT_NEAR(glm::length(x), 1, 1e-6F) << i;
        ASSERT_NEAR(glm::dot(x, n), 0, 1e-6F) << i;
        ASSERT_LT(glm::length(glm::cross(x, y) - n), 1e-6F) << i;
    }
}

}  // namespace
}  // namespace gn::math_test
