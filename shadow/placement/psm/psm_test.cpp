// SPDX-License-Identifier: MIT
#include "tests/warp_scene.h"

namespace gn::psm_test {
namespace {

double across(const GnLightView& view, double z) {
    return test::error_along(view, {0, 0, -z}, {1, 0, 0}, z);
}

double along(const GnLightView& view, double z) {
    return test::error_along(view, {0, 0, -z}, {0, 0, 1}, z);
}

/// C 3.2.2.3: the camera's own perspective makes the error across the view constant, and along it grow with z.
TEST(Psm, ErrorAcrossIsConstantAndAlongGrowsWithDistance) {
    const Scene scene = test::long_floor(2, 100);
    const GnLightView view = test::place(scene, "hard,placement=psm,psm.back=0,resolution=8192").views[0];
    for (const double z : {2.1, 5.0, 20.0, 99.0}) {
        EXPECT_NEAR(across(view, z) / across(view, 10), 1, 0.02) << z;
        EXPECT_NEAR(along(view, z) / along(view, 10), z / 10, 0.02 * z / 10) << z;
    }
}

/// Moving the virtual camera back by b makes n = z_n + b: the error across is that of a camera there.
TEST(Psm, MovingBackWeakensTheWarp) {
    const Scene scene = test::long_floor(2, 100);
    const GnLightView view = test::place(scene, "hard,placement=psm,psm.back=0.1,resolution=8192").views[0];
    for (const double z : {2.1, 5.0, 20.0, 99.0}) {
        EXPECT_NEAR(across(view, z) * z / (across(view, 10) * 10), (z + 10) / 20, 0.02) << z;
    }
}

/// A light from behind the camera needs no special case: the map is as good as for one from the front.
TEST(Psm, LightFromBehindMirrorsTheLightFromTheFront) {
    for (const double tilt : {0.2, 1.0, 3.0}) {
        const float t = static_cast<float>(tilt);
        const GnLightView front =
            test::place(test::long_floor(2, 100, vec3(0, 1, -t)), "hard,placement=psm,resolution=4096").views[0];
        const GnLightView behind =
            test::place(test::long_floor(2, 100, vec3(0, 1, t)), "hard,placement=psm,resolution=4096").views[0];
        for (const double z : {3.0, 10.0, 90.0}) {
            EXPECT_NEAR(along(front, z) / along(behind, z), 1, 0.02) << tilt << " " << z;
            EXPECT_NEAR(across(front, z) / across(behind, z), 1, 0.02) << tilt << " " << z;
        }
    }
}

}  // namespace
}  // namespace gn::psm_test
