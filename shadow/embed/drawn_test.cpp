// SPDX-License-Identifier: MIT
// A renderer that draws its casters itself gets the same V, bit for bit, as one that lends buffers of the same geometry; what
// such draws cannot fill is refused by name.
#include "tests/direct_scenes.h"
#include "tests/own_draws.h"

namespace gn::embed::drawn_test {
namespace {

using test::device;
using test::OwnDraws;
using test::run;

Result<Shadows> make(const std::string& recipe) {
    static const test::LentDevice lent;
    return Shadows::create({.device = lent.adopted(), .recipe = recipe});
}

/// The frame without any buffer.
Frame drawn(Frame frame, OwnDraws& draws) {
    frame.casters.positions = frame.casters.indices = frame.casters.transforms = {};
    frame.casters.objects = {};
    frame.casters.draw = std::ref(draws);
    return frame;
}

TEST(Drawn, GivesBitForBitWhatBuffersGive) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(by_hand::lit_garden(), 160, 90);
    OwnDraws draws(renderer);
    for (const char* recipe : {"hard,resolution=512", "pcf,resolution=512", "hard,resolution=512,placement=cascades",
                               "pcf,resolution=512,placement=cascades,cascades.scroll=1",
                               "pcf,resolution=256,placement=cube", "convolution,resolution=256"}) {
        Result<Shadows> by_buffers = make(recipe), by_draws = make(recipe);
        ASSERT_TRUE(by_buffers.ok() && by_draws.ok()) << by_buffers.why() << by_draws.why();
        std::vector<std::vector<float>> expected;
        const std::vector<std::string> refused = run(by_buffers.value(), renderer.frame());
        for (std::size_t i = 0; i < renderer.scene.lights.size(); ++i) {
            expected.push_back(renderer.visibility(i));
        }
        // Twice: what is kept goes on.
        for (std::uint32_t slot = 0; slot < 2; ++slot) {
            EXPECT_EQ(run(by_draws.value(), drawn(renderer.frame(slot), draws)), refused) << recipe;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                EXPECT_EQ(renderer.visibility(i), expected[i]) << recipe << ", light " << i;
            }
        }
    }
    EXPECT_EQ(draws.lights.size(), renderer.scene.lights.size());
}

TEST(Drawn, MapsAreMadeOfItsDepths) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(by_hand::lit_garden(), 160, 90);
    OwnDraws draws(renderer);
    for (const char* recipe : {"esm,resolution=256", "msm,resolution=256,placement=cascades",
                               "vsm,resolution=256,vsm.slope_moment=0,placement=cascades,cascades.scroll=1"}) {
        Result<Shadows> by_buffers = make(recipe), by_draws = make(recipe);
        ASSERT_TRUE(by_buffers.ok() && by_draws.ok()) << by_buffers.why() << by_draws.why();
        const std::vector<std::string> refused = run(by_buffers.value(), renderer.frame());
        std::vector<std::vector<float>> expected;
        for (std::size_t i = 0; i < renderer.scene.lights.size(); ++i) {
            expected.push_back(renderer.visibility(i));
        }
        EXPECT_EQ(run(by_draws.value(), drawn(renderer.frame(), draws)), refused) << recipe;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            // The depth that is stored is rounded otherwise than the one that a fragment computes, by units in the last place.
            const std::vector<float> v = renderer.visibility(i);
            double most = 0;
            for (std::size_t p = 0; p < v.size(); ++p) {
                most = std::max(most, static_cast<double>(std::abs(v[p] - expected[i][p])));
            }
            EXPECT_LT(most, 0.01) << recipe << ", light " << i;
        }
    }
}

TEST(Drawn, EitherFormMayFollowTheOther) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(load_scene("contact"), 96, 64);
    OwnDraws draws(renderer);
    Result<Shadows> made = make("hard,resolution=512,placement=cascades,cascades.scroll=1");
    ASSERT_TRUE(made.ok()) << made.why();
    run(made.value(), renderer.frame());
    const std::vector<float> expected = renderer.visibility(0);
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::size_t before = draws.views;
        run(made.value(), i % 2 == 0 ? drawn(renderer.frame(i % 2), draws) : renderer.frame(i % 2));
        EXPECT_EQ(renderer.visibility(0), expected) << i;
        EXPECT_EQ(draws.views > before, i % 2 == 0) << i;
    }
    // What is kept is not drawn again, by whomever.
    run(made.value(), drawn(renderer.frame(), draws));
    const std::size_t before = draws.views;
    run(made.value(), drawn(renderer.frame(1), draws));
    EXPECT_EQ(draws.views, before);
}

TEST(Drawn, WhatOwnDrawsCannotFillIsRefusedByName) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(load_scene("contact"), 96, 64);
    OwnDraws draws(renderer);
    for (const auto& [recipe, word] :
         {std::pair{"vsm,resolution=256", "vsm.slope_moment=0"},
          {"hard,resolution=256,casters=midpoint", "casters = midpoint"},
          {"hard,resolution=256,placement=cascades,cascades.split=sdsm-minmax", "placement 'cascades'"}}) {
        Result<Shadows> made = make(recipe);
        ASSERT_TRUE(made.ok()) << made.why();
        const std::vector<std::string> refused = run(made.value(), drawn(renderer.frame(), draws));
        ASSERT_EQ(refused.size(), 1U);
        EXPECT_NE(refused.front().find(word), std::string::npos) << refused.front();
        EXPECT_NE(refused.front().find("lend their buffers"), std::string::npos) << refused.front();
        EXPECT_EQ(renderer.visibility(0), std::vector<float>(renderer.visibility(0).size(), 1.0F)) << "lit instead";
        EXPECT_EQ(run(made.value(), renderer.frame()), std::vector<std::string>{""}) << "buffers serve it";
    }
    EXPECT_EQ(draws.views, 0U);
}

TEST(Drawn, AThrownSentenceIsRecordsOwn) {
    test::LentRenderer renderer(load_scene("contact"), 96, 64);
    Result<Shadows> made = make("hard,resolution=256");
    ASSERT_TRUE(made.ok()) << made.why();
    Frame frame = renderer.frame();
    frame.casters.draw = [](const CasterView&) { throw std::runtime_error("no pipeline for casters yet"); };
    Result<std::vector<std::string>> recorded = std::vector<std::string>{};
    try {
        device().run([&](VkCommandBuffer commands) {
            recorded = made.value().record(commands, frame);
            throw Error("not submitted");
        });
    } catch (const Error&) {
        EXPECT_EQ(recorded.why(), "no pipeline for casters yet");
    }
    EXPECT_FALSE(recorded.ok());
    // The next frame knows nothing of it.
    const test::ValidationGuard guard;
    EXPECT_EQ(run(made.value(), renderer.frame()), std::vector<std::string>{""});
}

TEST(Foreseen, TellsWhatAFrameWillAskFor) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(by_hand::lit_garden(), 160, 90);
    OwnDraws draws(renderer);
    Result<Shadows> made = make("hard,resolution=512,placement=cascades,cascades.scroll=1");
    ASSERT_TRUE(made.ok()) << made.why();

    // Without any image or buffer.
    Frame frame = renderer.frame();
    std::vector<LentLight> lights(frame.lights.begin(), frame.lights.end());
    for (LentLight& light : lights) {
        light.visibility.image = VK_NULL_HANDLE;
    }
    frame.lights = lights;
    frame.receivers.depth.image = frame.receivers.normals.image = VK_NULL_HANDLE;
    frame.casters.positions.buffer = frame.casters.indices.buffer = frame.casters.transforms.buffer = VK_NULL_HANDLE;
    const Result<Foreseen> foreseen = made.value().foresee(frame);
    ASSERT_TRUE(foreseen.ok()) << foreseen.why();
    const Result<Foreseen> own = made.value().foresee(drawn(frame, draws));
    ASSERT_TRUE(own.ok()) << own.why();
    EXPECT_EQ(draws.views, 0U);

    // Then the first frame itself does what was told; what it was is known once its slot is taken up again.
    EXPECT_EQ(run(made.value(), renderer.frame()), foreseen.value().refused);
    run(made.value(), renderer.frame());
    const GraphStatistics done = made.value().completed(0);
    EXPECT_EQ(done.transient_bytes, foreseen.value().transient_bytes);
    std::vector<std::string> told;
    for (const PassTime& pass : foreseen.value().passes) {
        told.push_back(pass.name);
    }
    std::vector<std::string> passes;
    for (const PassTime& pass : done.passes) {
        passes.push_back(pass.name);
    }
    EXPECT_EQ(passes, told);

    // Kept maps of the sun, 3 or more layers of 512 x 512 x 4 bytes, and with buffers the mesh.
    const VkDeviceSize mesh = 12 * renderer.scene.positions_ws.size() + 12 * renderer.scene.triangles.size();
    EXPECT_GE(own.value().persistent_bytes, 3U * 512 * 512 * 4);
    EXPECT_GE(foreseen.value().persistent_bytes, own.value().persistent_bytes + mesh);
    EXPECT_EQ(own.value().casters.depth, VK_FORMAT_D32_SFLOAT);
    EXPECT_TRUE(own.value().casters.affine) << "the sun's cascades";
    EXPECT_TRUE(own.value().casters.bent) << "the lamps' cubes";
    EXPECT_EQ(own.value().casters.culled, VkCullModeFlags{VK_CULL_MODE_NONE});
}

}  // namespace
}  // namespace gn::embed::drawn_test
