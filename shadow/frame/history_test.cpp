// SPDX-License-Identifier: MIT
// What frames leave to the next: only what completed, however often a frame was declared or run.
#include "shadow/frame/history.h"

#include "tests/rig.h"

#include <gtest/gtest.h>

namespace gn::history_test {
namespace {

const TextureDesc desc{.name = "kept",
                       .format = VK_FORMAT_R32_SFLOAT,
                       .width = 4,
                       .height = 4,
                       .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};

TEST(History, PairsChangePlacesWhenAFrameCompletesAndNotBefore) {
    History history(test::device());
    const History::Pair first = history.pair(desc);
    EXPECT_EQ(first.before, nullptr);
    EXPECT_EQ(history.pair(desc).now, first.now) << "declared again, the frame is the same";
    history.advance();
    const History::Pair second = history.pair(desc);
    EXPECT_EQ(second.before, first.now);
    EXPECT_NE(second.now, first.now);
    history.advance();

    // A frame that does not ask leaves both where they are.
    history.advance();
    EXPECT_EQ(history.pair(desc).before, second.now);

    // Another description starts anew; so does a history that was cleared.
    TextureDesc larger = desc;
    larger.width = 8;
    EXPECT_EQ(history.pair(larger).before, nullptr);
    history.advance();
    history.clear();
    EXPECT_EQ(history.pair(larger).before, nullptr);
}

TEST(History, ATextureIsFreshUntilAFrameThatAskedForItCompletes) {
    History history(test::device());
    bool fresh = false;
    Texture2D* const texture = &history.texture(desc, fresh);
    EXPECT_TRUE(fresh);
    history.texture(desc, fresh);
    EXPECT_TRUE(fresh) << "nothing was drawn into it yet";
    history.advance();
    EXPECT_EQ(&history.texture(desc, fresh), texture);
    EXPECT_FALSE(fresh);
}

TEST(History, ValuesAreFoundOnceTheirFrameCompleted) {
    History history(test::device());
    EXPECT_EQ(history.before<int>("count"), nullptr);
    history.leave("count", 7);
    EXPECT_EQ(history.before<int>("count"), nullptr);
    history.advance();
    ASSERT_NE(history.before<int>("count"), nullptr);
    EXPECT_EQ(*history.before<int>("count"), 7);
    history.advance();
    EXPECT_NE(history.before<int>("count"), nullptr) << "a frame that leaves nothing takes nothing away";
    EXPECT_THROW(static_cast<void>(history.before<float>("count")), Error);
}

}  // namespace
}  // namespace gn::history_test
