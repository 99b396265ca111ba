// SPDX-License-Identifier: MIT
#include "shadow/scene/cookie.h"

#include "tests/direct_scenes.h"

namespace gn::cookie_test {
namespace {

using namespace by_hand;

TEST(Cookie, a_spots_picture_fills_the_square_around_its_cone) {
    GnLight light = spot({0, 2, 0}, {0, 0, 0}, 0.5F);
    light.right_ws = vec4(1, 0, 0, 0);
    const float edge = 2 * std::tan(0.5F);
    EXPECT_NEAR(glm::distance(gn_cookie_place(light, {0, 0, 0}), vec2(0.5F)), 0, 1e-6F);
    EXPECT_NEAR(glm::distance(gn_cookie_place(light, {edge, 0, 0}), vec2(1, 0.5F)), 0, 1e-5F);
    // Looking down with x to the right, -z is up: the picture's upper edge.
    EXPECT_NEAR(glm::distance(gn_cookie_place(light, {0, 0, -edge}), vec2(0.5F, 0)), 0, 1e-5F);
    EXPECT_NEAR(glm::distance(gn_cookie_place(light, {0, 1, -0.5F * edge}), vec2(0.5F, 0)), 0, 1e-5F)
        << "along the ray";
}

TEST(Cookie, a_points_picture_is_longitude_and_latitude) {
    const GnLight light = point({1, 2, 3});
    EXPECT_NEAR(glm::distance(gn_cookie_place(light, vec3(1, 2, 2)), vec2(0.5F)), 0, 1e-6F);
    EXPECT_NEAR(glm::distance(gn_cookie_place(light, vec3(2, 2, 3)), vec2(0.75F, 0.5F)), 0, 1e-6F);
    EXPECT_NEAR(gn_cookie_place(light, vec3(1, 3, 3)).y, 0, 1e-6F);
    EXPECT_FALSE(gn_takes_cookie(rectangle({0, 3, 0}, {0, 0, 0})));
    EXPECT_FALSE(gn_takes_cookie(spot({0, 2, 0}, {0, 0, 0}, 1.7F)));
}

TEST(Cookie, a_suns_picture_is_thrown_along_it_and_repeats) {
    GnLight light = sun({1, -1, 0});
    light.right_ws = vec4(0, 0, 1, 0);
    light.position_ws = vec4(2, 0, 1, 0);
    light.half_size = vec2(3, 2);
    const auto at = [&](vec3 p_ws) { return gn_cookie_place(light, p_ws); };
    EXPECT_NEAR(glm::distance(at({2, 0, 1}), vec2(0.5F)), 0, 1e-6F);
    EXPECT_NEAR(glm::distance(at({7, -5, 1}), vec2(0.5F)), 0, 1e-6F) << "along the ray";
    EXPECT_NEAR(glm::distance(at({2, 0, 4}), vec2(1, 0.5F)), 0, 1e-6F) << "half the width to the right";
    // Looking down towards +x with z to the right, up is towards (1, 1, 0).
    const float high = std::sqrt(2.0F);
    EXPECT_NEAR(glm::distance(at({2 + high, high, 1}), vec2(0.5F, 0)), 0, 1e-6F) << "half the height upwards";
    EXPECT_NEAR(glm::distance(at({2, 0, 1 + 12}), vec2(2.5F, 0.5F)), 0, 1e-5F) << "two pictures on";
}

TEST(Cookie, a_suns_picture_without_a_size_lies_over_the_scene_once) {
    SceneBuilder b;
    b.ground(4).box({-0.3F, 0, -0.3F}, {0.3F, 2, 0.3F}).camera({0, 3, 3}, {0, 0, 0}).light(sun({0.2F, -1, 0.1F}));
    Scene scene = b.scene();
    scene.textures.push_back({.name = "white", .image = {1, 1, {255, 255, 255, 255}}});
    scene.lights.front().cookie = 0;
    finish_scene(scene);
    const GnLight& light = scene.lights.front().shape;
    EXPECT_FLOAT_EQ(light.half_size.x, 0.5F * scene.bounds_ws.diagonal());
    for (const vec3 corner : scene.bounds_ws.corners()) {
        const vec2 at = gn_cookie_place(light, corner);
        EXPECT_TRUE(at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1) << at.x << ", " << at.y;
    }
    // What is given stays.
    scene.lights.front().shape.half_size = vec2(0.25F, 0.5F);
    finish_scene(scene);
    EXPECT_EQ(scene.lights.front().shape.half_size, vec2(0.25F, 0.5F));
}

// A picture whose left half is red and whose right half is blue: shading has their colours, and V is as it was.
void expect_halves(const GnLight& light) {
    const bool repeats = light.kind == uint(GN_LIGHT_DIRECTIONAL);
    const test::ValidationGuard guard;
    SceneBuilder b;
    b.ground(4).box({-0.3F, 0.5F, -0.3F}, {0.3F, 0.8F, 0.3F}).camera({0, 3, 3}, {0, 0, 0});
    b.light(light);
    Scene scene = b.scene();
    scene.environment = Light{.name = "night", .shape = {.kind = GN_LIGHT_ENVIRONMENT, .intensity = 0}, .spared = {}};
    // Left half red, right half a dark blue.
    Texture halves{.name = "halves", .image = {2, 1, {255, 0, 0, 255, 0, 0, 188, 255}}};
    const float blue = 0.503F;  // 188 in sRGB
    scene.textures.push_back(halves);
    const auto render = [&] {
        SceneGpu uploaded = upload_scene(device(), scene);
        return render_frame(device(), uploaded, scene.cameras.front(), load_recipe("volumes"),
                            {.width = 96, .height = 72});
    };
    const FrameResult plain = render();
    scene.lights.front().cookie = static_cast<int>(scene.textures.size()) - 1;
    const FrameResult coloured = render();
    EXPECT_EQ(plain.visibility[0].values, coloured.visibility[0].values);
    std::size_t judged = 0;
    for (std::size_t i = 0; i < plain.samples.position_ws.size(); ++i) {
        if (plain.visibility[0].values[i] == 0) {
            continue;
        }
        // Between the centres of two texels their colours mix.
        const float place = 2 * gn_cookie_place(light, vec3(plain.samples.position_ws[i])).x - 0.5F;
        const auto texel = [&](float index) {
            const float wrapped = repeats ? index - 2 * std::floor(index / 2) : std::clamp(index, 0.0F, 1.0F);
            return wrapped < 0.5F ? vec3(1, 0, 0) : vec3(0, 0, blue);
        };
        const float first = std::floor(place);
        const vec3 tint = glm::mix(texel(first), texel(first + 1), place - first);
        for (int c = 0; c < 3; ++c) {
            const float white = plain.picture.values[3 * i + static_cast<std::size_t>(c)];
            EXPECT_NEAR(coloured.picture.values[3 * i + static_cast<std::size_t>(c)], white * tint[c], 0.006F * white);
        }
        ++judged;
    }
    EXPECT_GT(judged, 300U);
}

TEST(Cookie, colours_the_light_and_leaves_V_alone) {
    GnLight light = spot({0, 2.5F, 0}, {0, 0, 0}, 0.7F);
    light.right_ws = vec4(1, 0, 0, 0);
    light.intensity = 10;
    expect_halves(light);
    light = sun({0.2F, -1, 0.1F});
    light.right_ws = vec4(1, 0, 0, 0);
    light.half_size = vec2(0.4F, 0.3F);
    light.intensity = 3;
    expect_halves(light);
}

}  // namespace
}  // namespace gn::cookie_test
