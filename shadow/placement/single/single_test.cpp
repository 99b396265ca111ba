// SPDX-License-Identifier: MIT
#include "tests/rig.h"

namespace gn::single_test {
namespace {

TEST(Single, SameAsFitOnASceneThatFillsTheView) {
    // Only the size of a texel differs, so that both are right to within their own staircase.
    const auto single = test::compare("contact", "hard,placement=single,resolution=1024");
    const auto fitted = test::compare("contact", "hard,placement=fit,resolution=1024");
    EXPECT_LE(*single.errors.mismatch, *single.errors.edge);
    EXPECT_LE(*fitted.errors.mismatch, *single.errors.mismatch);
}

TEST(Single, RefusesACornerLessSpotWithItsReason) {
    Scene scene = load_scene("contact");
    scene.lights.resize(1);
    scene.lights[0].shape.kind = GN_LIGHT_SPOT;
    scene.lights[0].shape.position_ws = vec4(0, 5, 0, 1);
    scene.lights[0].shape.cos_outer = 0.01F;
    try {
        check_recipe(load_recipe("hard,placement=single"), scene, scene.lights[0], test::device());
        FAIL() << "a spot of 89 degrees was accepted";
    } catch (const Refusal& refusal) {
        EXPECT_NE(std::string(refusal.what()).find("85 degrees"), std::string::npos) << refusal.what();
    }
}

}  // namespace
}  // namespace gn::single_test
