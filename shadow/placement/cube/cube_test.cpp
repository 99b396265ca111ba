// SPDX-License-Identifier: MIT
#include "shadow/placement/faces.glsl"
#include "shadow/placement/receivers.h"
#include "tests/rig.h"

#include <random>

namespace gn {
namespace {

Scene scene_around(vec3 light_ws) {
    Scene scene;
    scene.bounds_ws = Box{vec3(-10), vec3(10)};
    scene.lights.push_back({"point", {}});
    scene.lights[0].shape.kind = GN_LIGHT_POINT;
    scene.lights[0].shape.position_ws = vec4(light_ws, 1);
    return scene;
}

TEST(Cube, EveryDirectionFallsInsideItsFaceWithRoomForTheKernel) {
    const Scene scene = scene_around(vec3(1, 2, 3));
    FrameGraph graph(test::device());
    const SceneHandles handles;
    const ViewSamples samples;
    const FrameInput input{test::device(), graph, scene, handles, samples, nullptr, 0};
    Recipe recipe = load_recipe("pcf,resolution=256,pcf.size=9");
    LightViews views;
    add_cube_views(views, input, recipe);
    ASSERT_EQ(views.views.size(), 6U);

    const double reach = 2.0 * static_cast<double>(guard_of(recipe).texels) / 256;
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 2000; ++i) {
        const vec3 d_ws = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const auto face = static_cast<std::size_t>(glsl::gn_face_of(d_ws));
        const vec4 p_cs = views.views[face].cs_from_ws * vec4(vec3(1, 2, 3) + 4.0F * d_ws, 1);
        EXPECT_GT(p_cs.w, 0);
        EXPECT_LE(std::abs(p_cs.x / p_cs.w), 1 - reach + 1e-4) << "face " << face;
        EXPECT_LE(std::abs(p_cs.y / p_cs.w), 1 - reach + 1e-4) << "face " << face;
    }
}

/// A point light in a room with a rod that casts over face borders: no pixel may differ by more than edges explain.
TEST(Cube, NoSeamBetweenFaces) {
    const auto c = test::compare("overlap:light=point,hard=1", "hard,placement=cube,resolution=512");
    const auto fitted = test::compare("overlap:light=point,hard=1", "hard,placement=fit,resolution=512");
    EXPECT_LE(*c.errors.acne, 1e-3 + *fitted.errors.acne);
    EXPECT_LE(*c.errors.mismatch, 4 * *fitted.errors.mismatch + 1e-3);
}

}  // namespace
}  // namespace gn
