// SPDX-License-Identifier: MIT

#include "tests/rig.h"

#include <cstring>

namespace gn::depth_test {
namespace {

/// One level square at height y over the origin, lit from (0, 10, 0).
Scene square_at(float y) {
    Scene scene;
    scene.positions_ws = {vec3(-50, y, -50), vec3(50, y, -50), vec3(50, y, 50), vec3(-50, y, 50)};
    scene.normals_ws.assign(4, vec3(0, 1, 0));
    scene.uvs.assign(4, vec2(0));
    scene.triangles = {uvec3(0, 2, 1), uvec3(0, 3, 2)};
    scene.materials.emplace_back();
    scene.objects.push_back({"square", 0, 2, 0, Box{vec3(-50, y, -50), vec3(50, y, 50)}});
    Light light{"spot", {}};
    light.shape.kind = GN_LIGHT_SPOT;
    light.shape.position_ws = vec4(0, 10, 0, 1);
    light.shape.direction_ws = vec4(0, -1, 0, 0);
    light.shape.cos_outer = 0.7F;
    scene.lights.push_back(light);
    finish_scene(scene);
    return scene;
}

TEST(Depth, IsLinearInDistanceUnderAPerspectiveProjection) {
    const test::ValidationGuard guard;
    for (const float y : {-20.0F, 0.0F, 5.0F, 9.0F}) {
        const Scene scene = square_at(y);
        SceneGpu gpu = upload_scene(test::device(), scene);
        FrameGraph graph(test::device());
        const SceneHandles handles = import_scene(graph, gpu);
        const ViewSamples samples{.width = 64, .height = 64, .camera = scene.cameras[0]};
        const FrameInput input{test::device(), graph, scene, handles, samples, scene.lights.data()};
        Recipe recipe = load_recipe("hard,placement=single,resolution=64");
        LightViews views = recipe.placement->place(input, recipe);
        const ShadowMap map = recipe.map->add_map(input, recipe, views);
        graph.keep(map.texture());
        graph.execute(false);

        // Every texel of the level square has the same distance along the axis, whatever its angle.
        const std::vector<std::byte> bytes = graph.download(map.texture());
        std::vector<float> depth(64 * 64);
        ASSERT_EQ(bytes.size(), depth.size() * sizeof(float));
        std::memcpy(depth.data(), bytes.data(), bytes.size());
        const float expected = glm::dot(views.views[0].depth_from_ws, vec4(0, y, 0, 1));
        for (const float d : depth) {
            ASSERT_NEAR(d, expected, 1e-6);
        }
    }
}

TEST(Depth, AlphaTestedCastersAreCutOut) {
    // A square above another whose texture is transparent in one half.
    Scene scene = square_at(0);
    Texture half{.name = "half", .image = {2, 1, {255, 255, 255, 255, 255, 255, 255, 0}}, .repeat_u = false};
    scene.textures.push_back(half);
    Material leaf{.alpha_mode = AlphaMode::mask, .base_color_texture = 0};
    scene.materials.push_back(leaf);
    const auto base = static_cast<uint>(scene.positions_ws.size());
    for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
        scene.positions_ws.emplace_back(corner.x, 5, corner.y);
        scene.normals_ws.emplace_back(0, 1, 0);
        scene.uvs.emplace_back(0.5F * corner.x + 0.5F, 0.5F);
    }
    scene.triangles.emplace_back(base, base + 2, base + 1);
    scene.triangles.emplace_back(base, base + 3, base + 2);
    scene.objects.push_back(
        {"leaf", 2, 2, static_cast<int>(scene.materials.size()) - 1, Box{vec3(-1, 5, -1), vec3(1, 5, 1)}});
    scene.cameras = {Camera{.position_ws = vec3(0, 3, 9), .forward_ws = glm::normalize(vec3(0, -3, -9))}};
    const auto c = test::compare(scene, "hard,resolution=1024");
    EXPECT_LT(*c.errors.mismatch, 0.004);
    EXPECT_GT(std::count_if(c.truth.visibility.begin(), c.truth.visibility.end(), [](float v) { return v == 1; }),
              1000);
}

}  // namespace
}  // namespace gn::depth_test
