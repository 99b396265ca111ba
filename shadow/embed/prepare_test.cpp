// SPDX-License-Identifier: MIT
// A recipe that is asked for ahead: frames go on with the one before, or lit, and lose nothing by it.
#include "shadow/embed/embed.h"
#include "tests/lent_renderer.h"

#include <gtest/gtest.h>

#include <chrono>

namespace gn::embed::prepare_test {
namespace {

using test::run;

Result<Shadows> make(const std::string& recipe, bool in_background) {
    static const test::LentDevice lent;
    return Shadows::create({.device = lent.adopted(), .recipe = recipe, .in_background = in_background});
}

/// Records frames until nothing is awaited any more; `each` sees every frame that still was.
template <class Each>
void record_until_there(Shadows& shadows, test::LentRenderer& renderer, Each each) {
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint32_t i = 0; std::chrono::steady_clock::now() - begin < std::chrono::minutes(2); ++i) {
        const std::vector<std::string> refused = run(shadows, renderer.frame(i % 2));
        if (shadows.preparation().recipe.empty()) {
            return;
        }
        each(refused);
    }
    FAIL() << "it never came";
}

std::vector<float> first_visibility(const std::string& recipe, test::LentRenderer& renderer) {
    Result<Shadows> made = make(recipe, false);
    EXPECT_TRUE(made.ok()) << made.why();
    run(made.value(), renderer.frame());
    return renderer.visibility(0);
}

constexpr const char* soft_recipe = "evsm2,placement=cascades,resolution=256";

TEST(EmbedPrepare, FramesGoOnWithTheRecipeOfBefore) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(load_scene("contact"), 64, 48);
    const std::vector<float> soft = first_visibility(soft_recipe, renderer);
    Result<Shadows> made = make("hard,resolution=256", false);
    ASSERT_TRUE(made.ok()) << made.why();
    Shadows& shadows = made.value();
    run(shadows, renderer.frame());
    const std::vector<float> hard = renderer.visibility(0);
    ASSERT_NE(hard, soft);

    ASSERT_TRUE(shadows.prepare_recipe(soft_recipe).ok());
    EXPECT_EQ(shadows.preparation().recipe, soft_recipe);
    int frames = 0;
    record_until_there(shadows, renderer, [&](const std::vector<std::string>& refused) {
        ++frames;
        EXPECT_EQ(refused, std::vector<std::string>{""});
        EXPECT_EQ(renderer.visibility(0), hard) << frames;
    });
    EXPECT_GT(frames, 0);
    EXPECT_EQ(shadows.preparation().failed, "");
    EXPECT_EQ(renderer.visibility(0), soft) << "in the first frame that awaits nothing";

    // That frame, and those after it, found every pipeline.
    const std::uint64_t there = shadows.counters().pipelines;
    ++renderer.poses;
    run(shadows, renderer.frame());
    EXPECT_EQ(shadows.counters().pipelines, there);
}

TEST(EmbedPrepare, TheFirstRecipeMayComeLaterToo) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(load_scene("contact"), 64, 48);
    const std::vector<float> soft = first_visibility(soft_recipe, renderer);
    Result<Shadows> made = make(soft_recipe, true);
    ASSERT_TRUE(made.ok()) << made.why();
    EXPECT_EQ(made.value().refuses(renderer.scene.lights[0].shape), "");
    int frames = 0;
    record_until_there(made.value(), renderer, [&](const std::vector<std::string>& refused) {
        ++frames;
        EXPECT_NE(refused.at(0).find(soft_recipe), std::string::npos) << refused.at(0);
        const std::vector<float> v = renderer.visibility(0);
        EXPECT_EQ(v, std::vector<float>(v.size(), 1.0F));
    });
    EXPECT_GT(frames, 0);
    EXPECT_EQ(renderer.visibility(0), soft);
}

TEST(EmbedPrepare, WhatIsAskedForLastCounts) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(load_scene("contact"), 64, 48);
    const std::vector<float> hard = first_visibility("hard,resolution=128", renderer);
    Result<Shadows> made = make("pcf,resolution=128", false);
    ASSERT_TRUE(made.ok()) << made.why();
    Shadows& shadows = made.value();
    ASSERT_TRUE(shadows.prepare_recipe(soft_recipe).ok());
    run(shadows, renderer.frame());
    EXPECT_FALSE(shadows.prepare_recipe("no-such-recipe").ok());
    EXPECT_EQ(shadows.preparation().recipe, soft_recipe) << "a mistake changes nothing";
    ASSERT_TRUE(shadows.set_recipe("hard,resolution=128").ok());
    EXPECT_EQ(shadows.preparation().recipe, "");
    run(shadows, renderer.frame());
    EXPECT_EQ(renderer.visibility(0), hard);
}

}  // namespace
}  // namespace gn::embed::prepare_test
