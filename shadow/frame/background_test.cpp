// SPDX-License-Identifier: MIT
// Pipelines that a thread makes while frames are recorded without them.
#include "gpu/frames.h"
#include "gpu/pipeline_compiler.h"
#include "shadow/frame/frame.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace gn::background_test {
namespace {

constexpr uint width = 64, height = 48;

/// A device on which nothing is compiled yet, and a renderer of one scene on it.
struct Renderer {
    std::unique_ptr<Device> device = Device::create({.validation = test::device().validates()});
    Scene scene = by_hand::lit_garden();
    SceneGpu gpu = upload_scene(*device, scene);
    Frames frames{*device, 2};
    std::uint32_t frame = 0;

    std::vector<TextureHandle> declare(FrameGraph& graph, const PreparedRecipe& recipe) {
        const FrameCasters casters{scene, import_scene(graph, gpu)};
        const ViewSamples receivers = add_view_samples(graph, gpu, casters.handles, scene.camera(""), width, height);
        std::vector<TextureHandle> images;
        for (const LightShadow& shadow : add_frame(graph, receivers, casters, lights_of(scene), recipe)) {
            images.push_back(shadow.visibility.image);
            graph.keep(images.back());
        }
        return images;
    }
    void draw(const PreparedRecipe& recipe) {
        frames.begin(frame++ % 2);
        device->run([&](VkCommandBuffer commands) {
            FrameGraph graph(*device);
            declare(graph, recipe);
            graph.record(frames, commands);
        });
    }
    std::vector<float> visibility(const PreparedRecipe& recipe) {
        FrameGraph graph(*device);
        const TextureHandle first = declare(graph, recipe).front();
        graph.execute(false);
        const std::vector<std::byte> bytes = graph.download(first);
        std::vector<float> values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }
    void expect_silence() const { EXPECT_TRUE(device->messages().empty()) << device->messages().front(); }
};

TEST(BackgroundPipelines, AreMadeWhileAnotherRecipeIsRecorded) {
    Renderer renderer;
    Device& device = *renderer.device;
    const PreparedRecipe plain(device, load_recipe("hard,resolution=128"));
    const PreparedRecipe soft(device, load_recipe("evsm2,placement=cascades,resolution=128"));
    renderer.draw(plain);
    PipelineCompiler compiler(device);
    int waited = 0;
    bool ready = false;
    const auto begin = std::chrono::steady_clock::now();
    for (; !ready && std::chrono::steady_clock::now() - begin < std::chrono::minutes(2); ++waited) {
        FrameGraph graph(device);
        renderer.declare(graph, soft);
        const std::uint64_t made = device.counters().pipelines;
        ready = compiler.ready(graph);
        EXPECT_TRUE(!ready || device.counters().pipelines > made) << "what the thread made is there now";
        renderer.draw(plain);
    }
    ASSERT_TRUE(ready);
    EXPECT_GT(waited, 1);
    EXPECT_FALSE(compiler.busy());

    // Nothing is left to be made, and the shadows are those that waiting would have given.
    const Counters before = device.counters();
    renderer.draw(soft);
    EXPECT_EQ(device.counters().pipelines, before.pipelines);
    Renderer patient;
    EXPECT_EQ(renderer.visibility(soft), patient.visibility(PreparedRecipe(*patient.device, soft.recipe())));
    renderer.expect_silence();
    patient.expect_silence();
}

TEST(BackgroundPipelines, AreLeftWhereNobodyWaitsForThem) {
    Renderer renderer;
    const PreparedRecipe recipe(*renderer.device, load_recipe("msm,resolution=128"));
    {
        PipelineCompiler compiler(*renderer.device);
        FrameGraph graph(*renderer.device);
        renderer.declare(graph, recipe);
        EXPECT_FALSE(compiler.ready(graph));
        EXPECT_TRUE(compiler.busy());
    }
    renderer.draw(recipe);
    renderer.expect_silence();
}

TEST(BackgroundPipelines, FailInASentence) {
    const std::unique_ptr<Device> device = Device::create();
    PipelineCompiler compiler(*device);
    FrameGraph graph(*device);
    const BufferHandle buffer = graph.create(BufferDesc{.name = "nothing", .bytes = 4});
    graph.keep(buffer);
    graph.add_pass(
        "broken", [&](PassBuilder& pass) { pass.storage_write(buffer); },
        [](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "broken", "void main() { nonsense }\n"}, {}});
        });
    EXPECT_FALSE(compiler.ready(graph));
    const auto wait = [&] {
        for (int i = 0; i < 1000 && compiler.busy(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return compiler.ready(graph);
    };
    try {
        wait();
        FAIL() << "a broken shader is no pipeline";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("broken"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace gn::background_test
