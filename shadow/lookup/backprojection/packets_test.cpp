// SPDX-License-Identifier: MIT
// What receivers find together is what each finds by itself.
#include "tests/rig.h"

#include <cmath>

namespace gn::packets_test {
namespace {

/// The larger area that a packet searches holds nothing more that hides the light from any of its receivers.
TEST(BackprojectionPacketsRendered, TogetherReceiversSeeWhatEachSeesAlone) {
    // A picture whose sides are no multiples of the packet's, with packets across the edges of the box.
    const test::ComparisonOptions size{.width = 97, .height = 73, .samples = 1};
    for (const char* scene : {"slab", "contact:radius=3"}) {
        const auto values = [&](int packet) {
            return test::compare(scene,
                                 fmt::format("backprojection,resolution=64,backprojection.budget=0,backprojection."
                                             "occluder=contour,backprojection.packet={}",
                                             packet),
                                 size)
                .visibility()
                .values;
        };
        EXPECT_EQ(values(2), values(1)) << scene;
    }
}

/// With a budget the joint search may be a level coarser; both levels are within what they err by.
TEST(BackprojectionPacketsRendered, WithABudgetTheyErrNoMore) {
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 64};
    const std::string recipe = "backprojection,backprojection.occluder=contour,backprojection.budget=64";
    const auto alone = test::compare("slab", recipe, size);
    const auto together = test::compare("slab", recipe + ",backprojection.packet=2", size);
    EXPECT_LE(*together.errors.rmse, 1.1 * *alone.errors.rmse + 0.002);
}

}  // namespace
}  // namespace gn::packets_test
