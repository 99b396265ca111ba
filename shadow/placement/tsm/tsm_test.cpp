// SPDX-License-Identifier: MIT
#include "tests/warp_scene.h"

namespace gn::tsm_test {
namespace {

/// Martin and Tan: the focus region ends at the 80 % line, whatever its length.
TEST(Tsm, FocusEndsAtItsShareOfTheMap) {
    for (const double focus : {3.0, 5.0, 20.0, 60.0}) {
        for (const double share : {0.5, 0.8}) {
            if (focus > 0.8 * share * 100) {
                continue;  // it has that much of the map without a warp
            }
            const Scene scene = test::long_floor(2, 100);
            const auto recipe =
                fmt::format("hard,placement=tsm,tsm.near=0,resolution=4096,tsm.share={},tsm.focus={}", share, focus);
            const GnLightView view = test::place(scene, recipe).views[0];
            const auto at = [&](double z) { return test::uv_of(view, {0, 0, -z}); };
            // Boxes are given a little thickness.
            const double slack = 1e-5 * static_cast<double>(scene.bounds_ws.diagonal());
            const double whole = glm::length(at(100 + slack) - at(2 - slack));
            EXPECT_NEAR(glm::length(at(focus) - at(2 - slack)) / whole, share, 1e-3) << focus;
        }
    }
}

/// A focus beyond its share of the map needs no warp.
TEST(Tsm, FarFocusLeavesTheFittedMap) {
    const Scene scene = test::long_floor(2, 100);
    const GnLightView view = test::place(scene, "hard,placement=tsm,tsm.focus=95").views[0];
    EXPECT_EQ(view.cs_from_ws, test::place(scene, "hard,placement=fit").views[0].cs_from_ws);
}

/// The default focus is the geometric mean: the nearer and the farther half of the ratios.
TEST(Tsm, DefaultFocusIsTheGeometricMean) {
    const Scene scene = test::long_floor(2, 200);
    const GnLightView view = test::place(scene, "hard,placement=tsm,tsm.near=0,resolution=4096").views[0];
    const auto at = [&](double z) { return test::uv_of(view, {0, 0, -z}); };
    EXPECT_NEAR(glm::length(at(20) - at(2)) / glm::length(at(200) - at(2)), 0.8, 2e-3);
}

}  // namespace
}  // namespace gn::tsm_test
