// SPDX-License-Identifier: MIT
// A device that is lost at any call, or that cannot make what it is asked for: one sentence through each boundary, nothing left
// behind, and everything can still be destroyed.
#include "shadow/embed/gnomon.h"
#include "shadow/embed/host.h"
#include "tests/lent_renderer.h"
#include "tests/vulkan_calls.h"

namespace gn::embed::lost_test {
namespace {

using test::device;
using test::FailingCall;

constexpr const char* recipe = "pcf,resolution=64";
constexpr const char* not_submitted = "the renderer does not submit it";

class Lost : public testing::TestWithParam<std::string> {
  protected:
    /// Lets the first, the second, the third call of the parameter's name fail in `act`, which gives its sentence, and later ones
    /// farther apart, until none does. Gives the first that did not.
    template <class Act>
    std::size_t fail_each(const Act& act) {
        for (std::size_t after = 0;; after += 1 + after / 2) {
            const std::size_t before = test::living();
            bool happened = false;
            {
                FailingCall failing(GetParam(), after);
                const std::string why = act();
                happened = failing.happened();
                if (happened && GetParam() != "vkDeviceWaitIdle") {  // nobody learns of that one: it is the end
                    EXPECT_NE(why, "") << GetParam() << " after " << after;
                    EXPECT_EQ(why.find('\n'), std::string::npos) << why;
                } else {
                    EXPECT_EQ(why, "") << GetParam() << " after " << after;
                }
            }
            EXPECT_EQ(test::living(), before) << GetParam() << " after " << after;
            if (!happened || testing::Test::HasFailure()) {
                return after;
            }
        }
    }
};

TEST_P(Lost, IsASentenceWhereARendererRecords) {
    const test::ValidationGuard guard;
    static test::LentRenderer renderer(load_scene("contact"), 16, 12);
    static const test::LentDevice lent;
    const Frame frame = renderer.frame();
    fail_each([&]() -> std::string {
        Result<Shadows> shadows = Shadows::create({.device = lent.adopted(), .recipe = recipe});
        if (!shadows.ok()) {
            return shadows.why();
        }
        // The commands of a frame that failed are not submitted.
        std::string why;
        try {
            device().run([&](VkCommandBuffer commands) {
                const auto recorded = shadows.value().record(commands, frame);
                why = recorded.why();
                throw Error(not_submitted);
            });
        } catch (const Error& error) {
            // The renderer's own calls may be what fails.
            return why.empty() && error.what() != std::string(not_submitted) ? error.what() : why;
        }
        return why;
    });
}

TEST(LostOnce, LeavesTheNextFrameWhole) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(load_scene("contact"), 16, 12);
    const test::LentDevice lent;
    const auto record = [&](Shadows& shadows) {
        std::string why;
        try {
            device().run([&](VkCommandBuffer commands) {
                why = shadows.record(commands, renderer.frame()).why();
                if (!why.empty()) {
                    throw Error(not_submitted);
                }
            });
        } catch (const Error& error) {
            EXPECT_EQ(error.what(), std::string(not_submitted));
        }
        return why;
    };
    const auto create = [&] { return Shadows::create({.device = lent.adopted(), .recipe = recipe}); };
    Result<Shadows> first = create();
    ASSERT_EQ(record(first.value()), "");
    const std::vector<float> expected = renderer.visibility(0);
    for (const char* call : {"vkCreateImage", "vkBindImageMemory", "vkAllocateMemory", "vkCreateImageView",
                             "vkCreateBuffer", "vkCreateGraphicsPipelines", "vkCreateComputePipelines"}) {
        for (std::size_t after = 0; after < 2; ++after) {
            Result<Shadows> shadows = create();
            ASSERT_TRUE(shadows.ok()) << shadows.why();
            {
                const FailingCall failing(call, after);
                const std::string why = record(shadows.value());
                EXPECT_EQ(why.empty(), !failing.happened()) << call << " after " << after;
                EXPECT_TRUE(after > 0 || failing.happened()) << call;
            }
            EXPECT_EQ(record(shadows.value()), "") << call << " after " << after;
            EXPECT_EQ(renderer.visibility(0), expected) << call << " after " << after;
        }
    }
}

TEST(LostInC, IsASentence) {
    const test::LentDevice lent;
    const AdoptedDevice adopted = lent.adopted();
    const GnomonInfo info{.size = sizeof(GnomonInfo),
                          .instance = adopted.instance,
                          .physical = adopted.physical,
                          .device = adopted.device,
                          .queue = adopted.queue,
                          .queue_family = adopted.queue_family,
                          .extension_count = static_cast<uint32_t>(adopted.extensions.size()),
                          .extensions = adopted.extensions.data(),
                          .features = adopted.features,
                          .recipe = recipe,
                          .width = 16,
                          .height = 16,
                          .lights = 1,
                          .frames_in_flight = 2,
                          .normals = GNOMON_NORMALS_NONE,
                          .reversed_depth = true};
    const std::size_t before = test::living();
    for (const char* call : {"vkQueueSubmit2", "vkWaitForFences", "vkCreateFence", "vkCreatePipelineCache"}) {
        const FailingCall failing(call);
        GnomonShadows* shadows = nullptr;
        const char* why = gnomon_create(&info, &shadows);
        ASSERT_NE(why, nullptr);
        EXPECT_NE(std::string(why).find("the device was lost in " + std::string(call)), std::string::npos) << why;
        EXPECT_EQ(shadows, nullptr);
        EXPECT_EQ(test::living(), before);
    }
    // A set of shadows whose device is lost later can be destroyed.
    GnomonShadows* shadows = nullptr;
    ASSERT_EQ(gnomon_create(&info, &shadows), nullptr);
    const FailingCall failing("vkDeviceWaitIdle");
    gnomon_destroy(shadows);
    EXPECT_EQ(test::living(), before);
}

TEST_P(Lost, IsASentenceWhereASceneIsMeasured) {
    const test::ValidationGuard guard;
    static const Scene scene = load_scene("contact");
    static const test::LentDevice lent;
    const std::size_t failed = fail_each([&]() -> std::string {
        Result<host::Session> session = host::Session::adopt(lent.adopted());
        if (!session.ok()) {
            return session.why();
        }
        const Result<Done> set = session.value().set_scene(scene);
        if (!set.ok()) {
            return set.why();
        }
        // Samples are reduced by dispatches: every kind of pipeline is made.
        return session.value()
            .render(scene.cameras.front(), "sdsm,resolution=64", {.width = 16, .height = 12, .repeat = 1})
            .why();
    });
    EXPECT_EQ(failed > 0, GetParam() != "vkGetQueryPoolResults" && GetParam() != "vkCreateQueryPool")
        << "only devices with timestamps have queries";
}

INSTANTIATE_TEST_SUITE_P(Calls, Lost, testing::ValuesIn(test::calls_that_can_fail()),
                         [](const auto& test) { return test.param.substr(2); });

}  // namespace
}  // namespace gn::embed::lost_test
