// SPDX-License-Identifier: MIT
// What glows around a lamp, at any scale; what is glass and what is a mask.
#include "shadow/scene/casting.h"

#include "shadow/scene/testing.h"

namespace gn::casting_test {
namespace {

/// A glowing box between two corners, its lid left off where `open`, and a lamp; all scaled about zero.
Scene bulb(vec3 low, vec3 high, bool open, vec3 lamp, float scale, uint kind = GN_LIGHT_POINT) {
    Scene scene;
    scene.name = "bulb";
    scene.materials = {{.name = "glow", .emissive = vec3(1)}, {.name = "grey"}};
    for (int i = 0; i < 8; ++i) {
        scene.positions_ws.push_back(
            scale * vec3((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z));
    }
    scene.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                       {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {2, 6, 7}, {2, 7, 3}};
    scene.triangles.resize(open ? 10 : 12);
    scene.objects = {
        {.name = "bulb", .triangle_count = static_cast<std::uint32_t>(scene.triangles.size()), .material = 0}};
    Light light{.name = "lamp", .shape = {}, .spared = {}};
    light.shape.kind = kind;
    light.shape.position_ws = vec4(scale * lamp, 1);
    scene.lights = {light};
    return scene;
}

bool spares(Scene scene) {
    finish_scene(scene);
    EXPECT_EQ(scene.lights[0].spared.empty(), casts(scene, 0, &scene.lights[0]));
    EXPECT_TRUE(casts(scene, 0, nullptr));
    return !scene.lights[0].spared.empty();
}

TEST(Bulbs, AreSparedAtAnyScale) {
    for (const float scale : {1e-4F, 1.0F, 1e6F}) {
        for (const bool open : {false, true}) {
            // Within, off the middle; touching the outside; a tenth of the least extent away, and farther.
            EXPECT_TRUE(spares(bulb(vec3(-1), vec3(1), open, {0.3F, 0.5F, -0.4F}, scale))) << scale << open;
            EXPECT_TRUE(spares(bulb(vec3(-1), vec3(1), open, {1.01F, 0, 0}, scale))) << scale << open;
            EXPECT_TRUE(spares(bulb(vec3(-1), vec3(1), open, {1.19F, 0, 0}, scale))) << scale << open;
            EXPECT_FALSE(spares(bulb(vec3(-1), vec3(1), open, {1.25F, 0, 0}, scale))) << scale << open;
        }
        // A screen 2 m wide and 2 cm thick is no bulb of a lamp that stands 10 cm before it.
        EXPECT_FALSE(spares(bulb({-1, -1, -0.01F}, {1, 1, 0.01F}, false, {0, 0, 0.1F}, scale))) << scale;
    }
}

TEST(Bulbs, CastForTheSunAndWhenToldTo) {
    EXPECT_FALSE(spares(bulb(vec3(-1), vec3(1), false, vec3(0), 1, GN_LIGHT_DIRECTIONAL)));
    EXPECT_TRUE(spares(bulb(vec3(-1), vec3(1), false, vec3(0), 1, GN_LIGHT_RECTANGLE)));
    Scene told = bulb(vec3(-1), vec3(1), false, vec3(0), 1);
    told.objects[0].casts = true;
    EXPECT_FALSE(spares(told));
    Scene grey = bulb(vec3(-1), vec3(1), false, vec3(0), 1);
    grey.objects[0].material = 1;
    EXPECT_FALSE(spares(grey));
    // A bulb keeps its place where triangles before it are dropped.
    Scene second = bulb(vec3(-1), vec3(1), false, vec3(0), 1);
    second.triangles.insert(second.triangles.begin(), uvec3(0, 0, 1));
    second.objects[0].first_triangle = 1;
    second.objects.insert(second.objects.begin(), {.name = "nothing", .triangle_count = 1});
    finish_scene(second);
    EXPECT_EQ(second.lights[0].spared, std::vector<std::uint32_t>{0});
}

TEST(Glass, IsWhatLetsLightThrough) {
    Scene scene;
    scene.textures = {{.name = "plain", .image = {1, 1, {255, 255, 255, 255}}},
                      {.name = "holes", .image = {1, 1, {255, 255, 255, 90}}}};
    const auto glass = [&](Material material) { return lets_light_through(scene, material); };
    EXPECT_FALSE(glass({}));
    EXPECT_FALSE(glass({.alpha_mode = AlphaMode::blend})) << "a factor of 1 is a mask or solid";
    EXPECT_TRUE(glass({.base_color = vec4(1, 1, 1, 0.9F), .alpha_mode = AlphaMode::blend}));
    EXPECT_TRUE(glass({.base_color = vec4(1, 1, 1, 0.9F), .alpha_mode = AlphaMode::blend, .base_color_texture = 0}));
    EXPECT_FALSE(glass({.base_color = vec4(1, 1, 1, 0.9F), .alpha_mode = AlphaMode::blend, .base_color_texture = 1}))
        << "a texture with alpha makes a mask";
    EXPECT_FALSE(glass({.base_color = vec4(1, 1, 1, 0.9F), .alpha_mode = AlphaMode::mask}));
    EXPECT_TRUE(glass({.transmission = 0.2F}));
}

}  // namespace
}  // namespace gn::casting_test
