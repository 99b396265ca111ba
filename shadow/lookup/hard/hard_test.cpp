// SPDX-License-Identifier: MIT
#include "tests/rig.h"

namespace gn {
namespace {

TEST(Hard, MismatchHalvesAsTheResolutionDoubles) {
    double before = 0;
    for (const int resolution : {256, 512, 1024}) {
        const auto c =
            test::compare("contact", fmt::format("hard,resolution={}", resolution), {.width = 512, .height = 512});
        const double mismatch = *c.errors.mismatch;
        if (before > 0) {
            // A staircase's area is proportional to the texel; counting pixels adds the square root of their number.
            const double noise = 3 * std::sqrt(mismatch / static_cast<double>(c.errors.samples));
            EXPECT_LT(mismatch, 0.6 * before + noise) << resolution;
            EXPECT_GT(mismatch, 0.3 * before - noise) << resolution;
        }
        before = mismatch;
    }
    EXPECT_GT(before, 0);
}

}  // namespace
}  // namespace gn
