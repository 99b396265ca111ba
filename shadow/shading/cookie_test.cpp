// SPDX-License-Identifier: MIT
#include "shadow/scene/cookie.h"

#include "tests/direct_scenes.h"

namespace gn {
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
    EXPECT_FALSE(gn_takes_cookie(sun({0, -1, 0})));
    EXPECT_FALSE(gn_takes_cookie(spot({0, 2, 0}, {0, 0, 0}, 1.7F)));
}

TEST(Cookie, colours_the_light_and_leaves_V_alone) {
    const test::ValidationGuard guard;
    SceneBuilder b;
    b.ground(4).box({-0.3F, 0.5F, -0.3F}, {0.3F, 0.8F, 0.3F}).camera({0, 3, 3}, {0, 0, 0});
    GnLight light = spot({0, 2.5F, 0}, {0, 0, 0}, 0.7F);
    light.right_ws = vec4(1, 0, 0, 0);
    light.intensity = 10;
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
        const vec2 at = gn_cookie_place(light, vec3(plain.samples.position_ws[i]));
        if (plain.visibility[0].values[i] == 0 || std::abs(at.x - 0.5F) < 0.26F) {
            continue;  // between the texels' centres they are mixed
        }
        const vec3 tint = at.x < 0.5F ? vec3(1, 0, 0) : vec3(0, 0, blue);
        for (int c = 0; c < 3; ++c) {
            const float white = plain.picture.values[3 * i + static_cast<std::size_t>(c)];
            EXPECT_NEAR(coloured.picture.values[3 * i + static_cast<std::size_t>(c)], white * tint[c], 0.005F * white);
        }
        ++judged;
    }
    EXPECT_GT(judged, 300U);
}

}  // namespace
}  // namespace gn
