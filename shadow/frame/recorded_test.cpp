// SPDX-License-Identifier: MIT
// What a host records: the same V as measuring has, on receivers of its own, whatever order its lights come in.
#include "shadow/frame/frame.h"

#include "gpu/frames.h"
#include "shadow/frame/history.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

#include <gtest/gtest.h>

namespace gn::recorded_test {
namespace {

constexpr uint width = 64, height = 48;

/// A host's own pictures: receivers that it drew, and one to take V into for each light.
struct HostPictures {
    Texture2D position, normal;
    std::vector<Texture2D> visibility;
};

Texture2D picture(const char* name, VkFormat format, std::span<const std::byte> texels) {
    return upload_texture(test::device(),
                          {.name = name,
                           .format = format,
                           .width = width,
                           .height = height,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT},
                          texels);
}

HostPictures pictures_of(const Scene& scene, SceneGpu& gpu) {
    const CpuSamples samples = render_samples(test::device(), gpu, scene.camera(""), width, height);
    HostPictures pictures{
        picture("host positions", VK_FORMAT_R32G32B32A32_SFLOAT, std::as_bytes(std::span(samples.position_ws))),
        picture("host normals", VK_FORMAT_R32G32B32A32_SFLOAT, std::as_bytes(std::span(samples.normal_ws))),
        {}};
    const std::vector<float> nothing(std::size_t{width} * height, -1.0F);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        pictures.visibility.push_back(picture("host shadow", VK_FORMAT_R32_SFLOAT, std::as_bytes(std::span(nothing))));
    }
    return pictures;
}

/// Declares one frame as a host does; V of light i goes to pictures.visibility[lights[i].id].
std::vector<LightShadow> declare(FrameGraph& graph, const Scene& scene, SceneGpu& gpu, HostPictures& pictures,
                                 std::span<const FrameLight> lights, const PreparedRecipe& recipe,
                                 History* history = nullptr) {
    const FrameCasters casters{scene, import_scene(graph, gpu)};
    const ViewSamples receivers =
        lent_samples(graph, scene.camera(""), graph.import(pictures.position), graph.import(pictures.normal));
    std::vector<LightShadow> shadows = add_frame(graph, receivers, casters, lights, recipe, history);
    for (std::size_t i = 0; i < shadows.size(); ++i) {
        if (!shadows[i].refused.empty()) {
            continue;
        }
        const TextureHandle from = shadows[i].visibility.image, to = graph.import(pictures.visibility[lights[i].id]);
        graph.add_pass(
            "take",
            [&](PassBuilder& pass) {
                pass.copy_from(from);
                pass.copy_to(to);
            },
            [=](Recorder& r) { r.blit(from, {}, to, {}, VK_FILTER_NEAREST); });
    }
    return shadows;
}

std::vector<float> values_of(Texture2D& texture) {
    const std::vector<std::byte> bytes = download(test::device(), texture);
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

class RecordedFrame : public testing::TestWithParam<const char*> {};

TEST_P(RecordedFrame, HasTheShadowsThatMeasuringHasWhateverTheOrderOfLights) {
    const test::ValidationGuard guard;
    const Scene scene = by_hand::lit_garden();
    SceneGpu gpu = upload_scene(test::device(), scene);
    const PreparedRecipe recipe(test::device(), load_recipe(GetParam()));
    const FrameResult measured = render_frame(test::device(), gpu, scene.camera(""), recipe.recipe(),
                                              {.width = width, .height = height, .picture = false});
    HostPictures pictures = pictures_of(scene, gpu);
    std::vector<FrameLight> lights = lights_of(scene);
    Frames frames(test::device(), 2);
    History history(test::device());
    for (std::uint32_t i = 0; i < 3; ++i) {
        frames.begin(i % 2);
        test::device().run([&](VkCommandBuffer commands) {
            FrameGraph graph(test::device());
            declare(graph, scene, gpu, pictures, lights, recipe, &history);
            graph.record(frames, commands);
        });
        history.advance();
        for (const FrameLight& light : lights) {
            EXPECT_EQ(values_of(pictures.visibility[light.id]), measured.visibility[light.id].values)
                << GetParam() << ", frame " << i << ", light '" << light.light->name << "'";
        }
        std::reverse(lights.begin(), lights.end());
    }
}

INSTANTIATE_TEST_SUITE_P(Recipes, RecordedFrame,
                         testing::Values("hard,resolution=256", "pcf,placement=cascades,resolution=256",
                                         "evsm2,resolution=256"),
                         [](const auto& test) {
                             const std::string text = test.param;
                             return text.substr(0, text.find(','));
                         });

TEST(RecordedFrames, FindTheirPipelinesCompiled) {
    const Scene scene = by_hand::lit_garden();
    const std::unique_ptr<Device> device = Device::create();
    SceneGpu gpu = upload_scene(*device, scene);
    const PreparedRecipe recipe(*device, load_recipe("pcf,placement=cascades,resolution=256"));
    Frames frames(*device, 2);
    const auto build = [&](FrameGraph& graph) {
        const FrameCasters casters{scene, import_scene(graph, gpu)};
        const ViewSamples receivers = add_view_samples(graph, gpu, casters.handles, scene.camera(""), width, height);
        for (const LightShadow& shadow : add_frame(graph, receivers, casters, lights_of(scene), recipe)) {
            graph.keep(shadow.visibility.image);
        }
    };
    {
        FrameGraph graph(*device);
        build(graph);
        graph.compile();
    }
    const Counters compiled = device->counters();
    EXPECT_GT(compiled.pipelines, 0U);
    frames.begin(0);
    device->run([&](VkCommandBuffer commands) {
        FrameGraph graph(*device);
        build(graph);
        graph.record(frames, commands);
    });
    EXPECT_EQ(device->counters().pipelines, compiled.pipelines);
    EXPECT_EQ(device->counters().samplers, compiled.samplers);
}

TEST(RecordedFrames, RefuseInASentenceWhatAHostDoesNotLend) {
    const Scene scene = by_hand::lit_garden();
    SceneGpu gpu = upload_scene(test::device(), scene);
    HostPictures pictures = pictures_of(scene, gpu);
    for (const auto& [text, what] : {std::pair{"hard,casters=ids", "object"}, {"volumes", "depth"}}) {
        const PreparedRecipe recipe(test::device(), load_recipe(text));
        FrameGraph graph(test::device());
        const std::vector<FrameLight> lights = lights_of(scene);
        const std::vector<LightShadow> shadows = declare(graph, scene, gpu, pictures, lights, recipe);
        EXPECT_EQ(
            shadows.front().refused,
            fmt::format("the recipe reads the {} of the receivers, and the host lends none; positions and normals "
                        "alone serve other recipes",
                        what));
        EXPECT_FALSE(shadows.front().visibility.image.valid());
    }
    FrameGraph graph(test::device());
    const TextureHandle normal = graph.import(pictures.normal);
    try {
        lent_samples(graph, scene.camera(""), graph.import(pictures.visibility.front()), normal);
        FAIL() << "one channel is no position";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()),
                  "lent texture 'host shadow' of 64 x 48 in r32f: positions and normals are rgba32f, "
                  "both of 64 x 48");
    }
}

}  // namespace
}  // namespace gn::recorded_test
