// SPDX-License-Identifier: MIT
// The public boundary: values or sentences, never exceptions.
#include "shadow/host.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace gn::host {
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

}  // namespace
}  // namespace gn::host
