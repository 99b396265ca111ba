// SPDX-License-Identifier: MIT
// The public boundary: values or sentences, never exceptions.
#include "shadow/embed/host.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>

namespace gn::host::host_test {
namespace {

// Nothing throws but the construction of arguments, which is the caller's.
static_assert(std::is_same_v<decltype(&Session::create), Result<Session> (*)(const std::string&) noexcept>);
static_assert(std::is_same_v<decltype(&Session::adopt), Result<Session> (*)(const AdoptedDevice&) noexcept>);
static_assert(std::is_same_v<decltype(&Session::set_scene), Result<Done> (Session::*)(Scene) noexcept>);
static_assert(
    std::is_same_v<decltype(&Session::render),
                   Result<FrameResult> (Session::*)(const Camera&, const std::string&, const FrameOptions&) noexcept>);

TEST(Host, MistakesAreSentences) {
    EXPECT_NE(Session::create("a device that nobody has").why(), "");
    EXPECT_NE(Session::adopt({}).why(), "");

    Result<Session> session = Session::create();
    ASSERT_TRUE(session.ok()) << session.why();
    EXPECT_NE(session.value().render({}, "pcf", {}).why().find("set_scene"), std::string::npos);
    EXPECT_FALSE(session.value().load_scene("no such scene").ok());
    ASSERT_TRUE(session.value().load_scene("contact").ok());
    const Camera& camera = session.value().scene()->cameras.front();
    EXPECT_NE(session.value().render(camera, "pfc", {}).why().find("pcf"), std::string::npos);
    EXPECT_FALSE(session.value().render(camera, "pcf", {.width = 0, .height = 4}).ok());
}

TEST(Host, ASceneGoesInAndVisibilityComesOut) {
    Result<Session> session = Session::create();
    ASSERT_TRUE(session.ok()) << session.why();
    ASSERT_TRUE(session.value().load_scene("contact").ok());
    Session moved = std::move(session.value());
    const auto frame =
        moved.render(moved.scene()->cameras.front(), "hard", {.width = 64, .height = 64, .picture = false});
    ASSERT_TRUE(frame.ok()) << frame.why();
    ASSERT_EQ(frame.value().visibility.size(), moved.scene()->lights.size());
    int lit = 0;
    int dark = 0;
    for (const float v : frame.value().visibility.front().values) {
        lit += v == 1 ? 1 : 0;
        dark += v == 0 ? 1 : 0;
    }
    EXPECT_GT(lit, 500);
    EXPECT_GT(dark, 50);
}

/// A floor and a wall on it around a place, lit by a sun or not at all.
Scene wall_at(vec3 place_ws, bool lit) {
    Scene scene;
    scene.positions_ws = {{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}, {-1, 0, 0}, {1, 0, 0}, {1, 2, 0}, {-1, 2, 0}};
    for (vec3& p_ws : scene.positions_ws) {
        p_ws += place_ws;
    }
    scene.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
    scene.objects = {{.name = "floor", .first_triangle = 0, .triangle_count = 2},
                     {.name = "wall", .first_triangle = 2, .triangle_count = 2}};
    scene.materials.emplace_back();
    if (lit) {
        Light sun;
        sun.name = "sun";
        sun.shape.kind = GN_LIGHT_DIRECTIONAL;
        sun.shape.direction_ws = vec4(glm::normalize(vec3(0, -1, 1)), 0);
        scene.lights = {sun};
    }
    return scene;
}

Camera before_the_wall(vec3 place_ws) {
    return {.position_ws = place_ws + vec3(0, 5, 7), .forward_ws = glm::normalize(vec3(0, -5, -7))};
}

TEST(Host, AFarSceneStaysWhereTheHostHasIt) {
    Result<Session> session = Session::create();
    ASSERT_TRUE(session.ok()) << session.why();
    const FrameOptions options{.width = 64, .height = 64, .picture = false};
    std::vector<std::vector<float>> seen;
    // A place so far away that a file there would be moved; its coordinates are exact in floats.
    for (const vec3 place_ws : {vec3(0), vec3(4096, 0, -8192)}) {
        const Scene given = wall_at(place_ws, true);
        ASSERT_TRUE(session.value().set_scene(given).ok());
        EXPECT_EQ(session.value().scene()->positions_ws, given.positions_ws);
        EXPECT_EQ(session.value().scene()->origin, dvec3(0));
        const auto frame = session.value().render(before_the_wall(place_ws), "hard", options);
        ASSERT_TRUE(frame.ok()) << frame.why();
        seen.push_back(frame.value().visibility.front().values);
    }
    // Rounding at 8 km moves a shadow's edge by less than a pixel.
    std::size_t different = 0;
    for (std::size_t i = 0; i < seen[0].size(); ++i) {
        different += seen[0][i] != seen[1][i] ? 1 : 0;
    }
    EXPECT_LT(different, 64U) << "of " << seen[0].size() << " pixels; an outline of the floor is 100 pixels long";
    EXPECT_GT(std::count(seen[0].begin(), seen[0].end(), 1.0F), 500);
}

TEST(Host, NothingIsInvented) {
    Result<Session> session = Session::create();
    ASSERT_TRUE(session.ok()) << session.why();
    ASSERT_TRUE(session.value().set_scene(wall_at(vec3(0), false)).ok());
    EXPECT_TRUE(session.value().scene()->lights.empty());
    EXPECT_TRUE(session.value().scene()->cameras.empty());
    const auto frame = session.value().render(before_the_wall(vec3(0)), "pcf", {.width = 64, .height = 64});
    ASSERT_TRUE(frame.ok()) << frame.why();
    EXPECT_TRUE(frame.value().visibility.empty());
}

}  // namespace
}  // namespace gn::host::host_test
