// SPDX-License-Identifier: MIT
// Which lights get no map, and that V does not change where they reach nothing.
#include "shadow/light/culled/culled.h"
#include "shadow/light/culled/illuminance.h"
#include "tests/rig.h"

#include <algorithm>

namespace gn::culled_test {
namespace {

TEST(Culled, IlluminanceFallsWithTheSquareOfTheDistance) {
    GnLight lamp;
    lamp.kind = GN_LIGHT_POINT;
    lamp.intensity = 100;
    EXPECT_NEAR(culled::most_illuminance(lamp, {5, 10}), 4, 1e-6);
    EXPECT_NEAR(culled::least_illuminance(lamp, {5, 10}), 1, 1e-6);
    // As near as its own surface may be.
    lamp.radius = 1;
    EXPECT_NEAR(culled::most_illuminance(lamp, {6, 9}), 4, 1e-6);
    EXPECT_NEAR(culled::least_illuminance(lamp, {6, 9}), 1, 1e-6);
    EXPECT_GT(culled::most_illuminance(lamp, {0.5, 9}), 1e300);
    lamp.range = 20;
    EXPECT_EQ(culled::least_illuminance(lamp, {6, 9}), 0);

    GnLight sun;
    sun.intensity = 5e4F;
    EXPECT_NEAR(culled::most_illuminance(sun, {0, 1}), 5e4, 1);
    EXPECT_NEAR(culled::least_illuminance(sun, {0, 1}), 5e4, 1);

    GnLight panel;
    panel.kind = GN_LIGHT_RECTANGLE;
    panel.intensity = 1000;
    panel.half_size = vec2(0.3F, 0.4F);
    EXPECT_NEAR(culled::most_illuminance(panel, {4.5, 9}), 1000 * 0.48 / 16, 1e-3);
    EXPECT_EQ(culled::least_illuminance(panel, {4.5, 9}), 0);
}

/// The contact scene under a sun, and a lamp at an offset from the middle of its box's top.
Scene sun_and_lamp(vec3 away, float candela, float range) {
    Scene scene = test::built_in("contact");
    Light sun = scene.lights.front();
    sun.name = "sun";
    sun.shape.kind = GN_LIGHT_DIRECTIONAL;
    sun.shape.direction_ws = vec4(glm::normalize(vec3(0.3F, -1, 0.2F)), 0);
    sun.shape.intensity = 1000;
    sun.shape.angular_radius = 0;
    Light lamp = sun;
    lamp.name = "lamp";
    lamp.shape.kind = GN_LIGHT_POINT;
    const Box& box_ws = scene.objects.back().bounds_ws;
    lamp.shape.position_ws = vec4(vec3(box_ws.centre().x, box_ws.max.y, box_ws.centre().z) + away, 1);
    lamp.shape.intensity = candela;
    lamp.shape.range = range;
    lamp.shape.radius = 0;
    scene.lights = {sun, lamp};
    return scene;
}

FrameResult frame_of(Scene& scene, const std::string& recipe) {
    SceneGpu gpu = upload_scene(test::device(), scene);
    return render_frame(test::device(), gpu, scene.camera(""), load_recipe(recipe),
                        {.width = 96, .height = 96, .picture = false});
}

bool says(const FrameResult& frame, const std::string& light) {
    return std::any_of(frame.remarks.begin(), frame.remarks.end(), [&](const std::string& remark) {
        return remark.find("light '" + light + "' gets no map") != std::string::npos;
    });
}

/// Out of its range nothing counts: V is the same to the bit, one map fewer is drawn, and it is said.
TEST(Culled, LightsThatReachNothingSeenGetNoMap) {
    // Farther than its range, though within it along every axis.
    Scene scene = sun_and_lamp(vec3(40), 1e6F, 42);
    const FrameResult all = frame_of(scene, "pcf,resolution=256");
    const FrameResult some = frame_of(scene, "pcf,resolution=256,light=culled,culled.share=0");
    ASSERT_EQ(all.visibility.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(all.visibility[i].values, some.visibility[i].values) << i;
    }
    EXPECT_EQ(*std::max_element(some.visibility[1].values.begin(), some.visibility[1].values.end()), 0);
    EXPECT_GT(*std::max_element(some.visibility[0].values.begin(), some.visibility[0].values.end()), 0.9F);
    EXPECT_TRUE(says(some, "lamp"));
    EXPECT_FALSE(says(some, "sun"));
    EXPECT_FALSE(says(all, "lamp"));
    EXPECT_LT(some.statistics.passes.size(), all.statistics.passes.size());

    // Within its range it is drawn as ever.
    Scene near = sun_and_lamp(vec3(0, 4, 0), 1e6F, 42);
    const FrameResult reaches = frame_of(near, "pcf,resolution=256,light=culled,culled.share=0");
    EXPECT_EQ(reaches.visibility[1].values, frame_of(near, "pcf,resolution=256").visibility[1].values);
    EXPECT_FALSE(says(reaches, "lamp"));
}

/// A lamp 10 m away gives at most a hundredth of its candela in lux; of a sun of 1000 lux a hundredth is 10.
TEST(Culled, FaintLightsShineWithoutAShadow) {
    for (const auto& [candela, faint] : {std::pair{900.0F, true}, std::pair{1200.0F, false}}) {
        Scene scene = sun_and_lamp(vec3(0, 10, 0), candela, 0);
        const FrameResult frame = frame_of(scene, "pcf,resolution=256,light=culled,culled.share=0.01");
        EXPECT_EQ(says(frame, "lamp"), faint) << candela;
        EXPECT_FALSE(says(frame, "sun"));
        const std::string told = faint ? "none" : "pcf";
        const std::vector<float> expected =
            frame_of(scene, told + (faint ? "" : ",resolution=256")).visibility[1].values;
        EXPECT_EQ(frame.visibility[1].values, expected) << candela;
    }
}

}  // namespace
}  // namespace gn::culled_test
