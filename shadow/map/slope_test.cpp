// SPDX-License-Identifier: MIT
// Depth is clamped before the near plane of a view, and what is clamped has no slope.
#include "tests/rig.h"

namespace gn::slope_test {
namespace {

void add_quad(Scene& scene, const std::array<vec3, 4>& corners) {
    const auto base = static_cast<uint>(scene.positions_ws.size());
    scene.positions_ws.insert(scene.positions_ws.end(), corners.begin(), corners.end());
    scene.triangles.emplace_back(base, base + 1, base + 2);
    scene.triangles.emplace_back(base, base + 2, base + 3);
}

/// A floor under the noon sun and a sheet above the camera, level or so steep that it rises 42 m over 1.5 m. Both cast
/// the same shadow.
Scene roofed(float rise) {
    Scene scene;
    add_quad(scene, {vec3(-8, 0, -8), vec3(-8, 0, 8), vec3(8, 0, 8), vec3(8, 0, -8)});
    add_quad(scene, {vec3(-0.75F, 4, -3), vec3(-0.75F, 4, 3), vec3(0.75F, 4 + rise, 3), vec3(0.75F, 4 + rise, -3)});
    scene.cameras.push_back({.position_ws = vec3(0, 3, 0.1F),
                             .forward_ws = vec3(0, -1, 0),
                             .up_ws = vec3(0, 0, -1),
                             .near = 0.1F,
                             .far = 10});
    scene.lights.push_back({"sun", {}});
    scene.lights[0].shape.direction_ws = vec4(0, -1, 0, 0);
    finish_scene(scene);
    return scene;
}

/// A texel of the steep sheet spans more depth than the whole map has. Were that taken for the spread of the clamped depth,
/// a third of the light would come through.
TEST(Slope, OfAClampedCasterIsNone) {
    for (const char* recipe : {"vsm,vsm.bleeding=0", "evsm2,evsm.bleeding=0", "evsm4,evsm.bleeding=0",
                               "lvsm,lvsm.bleeding=0", "sat-vsm,sat-vsm.bleeding=0"}) {
        const std::string text = std::string(recipe) + ",placement=fit,resolution=64";
        const test::ComparisonOptions options{.width = 96, .height = 96, .samples = 1};
        const auto level = test::compare(roofed(0), text, options);
        const auto steep = test::compare(roofed(42), text, options);
        ASSERT_TRUE(level.errors.leak && steep.errors.leak) << recipe;
        // Rims are drawn from other triangles, whose corners round to another 1/256 of a texel.
        EXPECT_NEAR(*steep.errors.leak, *level.errors.leak, 1.0 / 256) << recipe;
    }
}

}  // namespace
}  // namespace gn::slope_test
