// SPDX-License-Identifier: MIT
// A steady frame, from its view samples to its picture, creates nothing and composes no shader: of every shipped recipe, with
// a camera that moves, and while a parameter's value changes.
#include "gpu/frames.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/history.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>

#include <fstream>

namespace gn {

/// For messages of failed expectations.
void PrintTo(const Counters& c, std::ostream* out) {
    *out << c.pipelines << " pipelines, " << c.samplers << " samplers, " << c.images << " images, " << c.buffers
         << " buffers, " << c.views << " views, " << c.allocations << " allocations, " << c.pools << " pools, "
         << c.texts << " shader texts";
}

namespace {

constexpr uint width = 48, height = 32, resolution = 128;
constexpr int warm = 2, steady = test::sanitized ? 1 : 2;  // each slot once

/// Threads of this process.
int threads() {
    std::ifstream status("/proc/self/status");
    std::string word;
    int count = 0;
    while (status >> word) {
        if (word == "Threads:") {
            status >> count;
        }
    }
    return count;
}

/// A renderer that records its frames: own view samples, two slots, a camera that goes sideways.
struct Renderer {
    const Scene& scene;
    SceneGpu gpu = upload_scene(test::device(), scene);
    Frames frames{test::device(), 2};
    History history{test::device()};
    int frame = 0;

    void draw(const PreparedRecipe& recipe) {
        frames.begin(static_cast<std::uint32_t>(frame % 2));
        test::device().run([&](VkCommandBuffer commands) {
            FrameGraph graph(test::device());
            declare(graph, recipe);
            graph.record(frames, commands);
        });
        history.advance();
        ++frame;
    }

    void declare(FrameGraph& graph, const PreparedRecipe& recipe) {
        Camera camera = scene.camera("");
        camera.position_ws.x += 0.02F * static_cast<float>(frame);
        const FrameCasters casters{scene, import_scene(graph, gpu)};
        const ViewSamples receivers = add_view_samples(graph, gpu, casters.handles, camera, width, height);
        std::vector<TextureHandle> visibility;
        for (const LightShadow& shadow : add_frame(graph, receivers, casters, lights_of(scene), recipe, &history)) {
            visibility.push_back(shadow.visibility.image);
        }
        FrameInput input{test::device(), graph, scene, casters.handles, receivers};
        input.prepared = &recipe;
        graph.keep(add_shading(input, visibility));
    }
};

class Steady : public testing::TestWithParam<std::string> {};

TEST_P(Steady, FramesCreateNothing) {
    const test::ValidationGuard guard;
    const Scene scene = by_hand::lit_garden();
    Renderer renderer{scene};
    const std::string text = test::with_small_maps(GetParam(), resolution);
    const PreparedRecipe recipe(test::device(), load_recipe(text));
    for (int i = 0; i < warm; ++i) {
        renderer.draw(recipe);
    }
    const Counters before = test::device().counters();
    const int threads_before = threads();
    for (int i = 0; i < steady; ++i) {
        renderer.draw(recipe);
        ASSERT_EQ(test::device().counters(), before) << GetParam() << ", frame " << renderer.frame;
    }
    EXPECT_EQ(threads(), threads_before);

    // A value that only shaders are given makes nothing either.
    if (recipe.recipe().map != nullptr) {
        const PreparedRecipe other(test::device(), load_recipe(text + ",bias.normal=1.75"));
        renderer.draw(other);
        EXPECT_EQ(test::device().counters(), before) << GetParam() << " with another bias";
    }
}

/// Maps that the camera takes along and that are drawn where it newly looks.
INSTANTIATE_TEST_SUITE_P(Kept, Steady, testing::Values("cascades,cascades.scroll=1"),
                         [](const auto&) { return std::string("cascades_scroll"); });

/// With sanitizers, which meet every recipe elsewhere, one of sixteen: what they see here is the frame after the frame.
INSTANTIATE_TEST_SUITE_P(Recipes, Steady, testing::ValuesIn(test::picked(test::drawn_recipes())), [](const auto& test) {
    std::string name = test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace gn
