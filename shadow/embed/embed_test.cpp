// SPDX-License-Identifier: MIT
// The boundary that a renderer records through: V against the truth of its own samples, layouts, what a steady sequence makes,
// movement, mistakes.
#include "shadow/embed/embed.h"

#include "tests/direct_scenes.h"
#include "tests/lent_renderer.h"

namespace gn::embed::embed_test {
namespace {

using test::device;
using test::run;

Result<Shadows> make(const std::string& recipe, const ReceiverForm& form = {}, const Limits& limits = {}) {
    static const test::LentDevice lent;
    return Shadows::create({.device = lent.adopted(), .recipe = recipe, .limits = limits, .receivers = form});
}

struct Judged {
    std::size_t counted = 0, wrong = 0, lit = 0, dark = 0;
};

/// V against one ray a sample, away from the edges of shadows.
Judged judge(const test::LentRenderer& renderer, const std::vector<float>& v, std::size_t light) {
    const TruthResult truth = Truth(renderer.scene)
                                  .trace(renderer.seen.position_ws, renderer.seen.normal_ws,
                                         renderer.scene.lights[light].shape, {.samples = 1});
    const auto edges = edge_pixels(truth.visibility, truth.counted, static_cast<int>(renderer.seen.width),
                                   static_cast<int>(renderer.seen.height));
    Judged judged;
    for (std::size_t i = 0; i < v.size(); ++i) {
        if (truth.counted[i] == 0 || edges[i] != 0) {
            continue;
        }
        ++judged.counted;
        judged.wrong += v[i] != truth.visibility[i] ? 1 : 0;
        ++(truth.visibility[i] > 0.5F ? judged.lit : judged.dark);
    }
    return judged;
}

/// The scene with points for lights, so that one ray is the truth.
Scene hard_lit(Scene scene) {
    for (Light& light : scene.lights) {
        light.shape.radius = light.shape.angular_radius = 0;
        light.shape.half_size = vec2(0);
    }
    return scene;
}

TEST(Embed, DepthAndNormalsOfARendererGiveTheTracedShadow) {
    const test::ValidationGuard guard;
    for (const char* name : {"contact", "stack"}) {
        for (const char* recipe : {"hard,resolution=2048", "hard,resolution=1024,placement=cascades"}) {
            test::LentRenderer renderer(hard_lit(load_scene(name)), 160, 120);
            Result<Shadows> shadows = make(recipe);
            ASSERT_TRUE(shadows.ok()) << shadows.why();
            EXPECT_EQ(run(shadows.value(), renderer.frame()), std::vector<std::string>{""});
            const Judged judged = judge(renderer, renderer.visibility(0), 0);
            // A texel of the map is smaller than a pixel here, so that only edges can differ.
            EXPECT_EQ(judged.wrong, 0U) << recipe << " on " << name << ", of " << judged.counted;
            EXPECT_GT(judged.lit, 5000U);
            EXPECT_GT(judged.dark, 200U);
        }
    }
}

TEST(Embed, LightsOfEveryKindComeInAnyOrder) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(hard_lit(by_hand::lit_garden()), 160, 90);
    Result<Shadows> shadows = make("pcf,placement=cascades");
    ASSERT_TRUE(shadows.ok()) << shadows.why();
    Frame frame = renderer.frame();
    run(shadows.value(), frame);
    std::vector<std::vector<float>> first;
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        first.push_back(renderer.visibility(i));
        EXPECT_GT(*std::max_element(first[i].begin(), first[i].end()), 0.5F) << i;
        EXPECT_EQ(*std::min_element(first[i].begin(), first[i].end()), 0.0F) << i;
    }
    frame = renderer.frame();
    const std::vector<LentLight> turned(frame.lights.rbegin(), frame.lights.rend());
    frame.lights = turned;
    run(shadows.value(), frame);
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(renderer.visibility(i), first[i]) << "light " << i << " in another order";
    }
}

TEST(Embed, ASteadySequenceCreatesNothing) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(hard_lit(load_scene("contact")), 96, 64);
    Result<Shadows> made = make("pcf,placement=cascades");
    ASSERT_TRUE(made.ok()) << made.why();
    Shadows& shadows = made.value();
    for (std::uint32_t i = 0; i < 2; ++i) {
        ++renderer.poses;
        run(shadows, renderer.frame(i % 2));
    }
    const Counters before = shadows.counters();
    for (std::uint32_t i = 0; i < 6; ++i) {
        ++renderer.poses;
        run(shadows, renderer.frame(i % 2));
    }
    EXPECT_EQ(shadows.counters(), before);
    EXPECT_GT(shadows.completed(0).passes.size(), 2U);
}

TEST(Embed, TransformsMayLieElsewhereInEveryFrame) {
    const test::ValidationGuard guard;
    // A ring of as many places as there are frames, each but the last with transforms that hide everything.
    test::LentRenderer renderer(hard_lit(load_scene("contact")), 96, 64);
    Result<Shadows> made = make("pcf,placement=cascades");
    ASSERT_TRUE(made.ok()) << made.why();
    Shadows& shadows = made.value();
    run(shadows, renderer.frame());
    const std::vector<float> still = renderer.visibility(0);
    constexpr std::size_t places = 8;
    const std::size_t objects = renderer.objects.size();
    std::vector<mat4> ring(places * objects, glm::translate(mat4(1), vec3(0, -100, 0)));
    std::fill(ring.end() - static_cast<std::ptrdiff_t>(objects), ring.end(), mat4(1));
    const auto bytes = std::as_bytes(std::span(ring));
    const Buffer buffer = upload_buffer(
        device(), {.name = "ring", .bytes = bytes.size(), .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}, bytes);
    std::optional<Counters> settled;
    for (std::size_t i = 0; i < places; ++i) {
        ++renderer.poses;
        Frame frame = renderer.frame(static_cast<std::uint32_t>(i % 2));
        const VkDeviceSize share = objects * sizeof(mat4);
        frame.casters.transforms = {buffer.vk(), i * share, share};
        run(shadows, frame);
        settled = i == 3 ? shadows.counters() : settled;
        EXPECT_EQ(renderer.visibility(0) == still, i + 1 == places) << "place " << i;
    }
    EXPECT_EQ(shadows.counters(), *settled);
    Frame frame = renderer.frame();
    ++frame.casters.poses;
    frame.casters.transforms.bytes = 4;
    device().run([&](VkCommandBuffer commands) {
        EXPECT_NE(shadows.record(commands, frame).why().find("transforms"), std::string::npos);
    });
}

/// V of a light from shadows that never saw another frame.
std::vector<float> alone(test::LentRenderer& renderer, const std::string& recipe, std::size_t light) {
    Result<Shadows> fresh = make(recipe);
    EXPECT_TRUE(fresh.ok()) << fresh.why();
    run(fresh.value(), renderer.frame());
    return renderer.visibility(light);
}

TEST(Embed, AFrameThatFailedLeavesNothingBehind) {
    const test::ValidationGuard guard;
    // Maps are kept over frames. The sun's is declared in a frame that fails at the second light, and never drawn.
    const char* recipe = "hard,resolution=512,placement=cascades,cascades.scroll=1";
    test::LentRenderer renderer(hard_lit(by_hand::lit_garden()), 96, 54);
    ASSERT_GT(renderer.scene.lights.size(), 1U);
    const std::vector<float> expected = alone(renderer, recipe, 0);
    Result<Shadows> made = make(recipe);
    ASSERT_TRUE(made.ok()) << made.why();
    Shadows& shadows = made.value();
    Frame frame = renderer.frame();
    std::vector<LentLight> lights(frame.lights.begin(), frame.lights.end());
    lights[1].visibility.image = VK_NULL_HANDLE;
    frame.lights = lights;
    device().run([&](VkCommandBuffer commands) { EXPECT_FALSE(shadows.record(commands, frame).ok()); });

    // A frame without the sun completes; the sun's own next frame finds a map that was drawn.
    frame = renderer.frame(1);
    frame.lights = frame.lights.subspan(1);
    run(shadows, frame);
    run(shadows, renderer.frame(0));
    EXPECT_EQ(renderer.visibility(0), expected);
}

TEST(Embed, PicturesOfAnotherSizeAndCutsBeginAnew) {
    const test::ValidationGuard guard;
    const char* recipe = "pcf,resolution=512,placement=cascades,cascades.scroll=1";
    test::LentRenderer small(hard_lit(load_scene("contact")), 96, 64);
    test::LentRenderer large(hard_lit(load_scene("contact")), 160, 120);
    const std::vector<float> expected = alone(small, recipe, 0), expected_large = alone(large, recipe, 0);
    Result<Shadows> made = make(recipe);
    ASSERT_TRUE(made.ok()) << made.why();
    Shadows& shadows = made.value();
    for (std::uint32_t i = 0; i < 6; ++i) {
        test::LentRenderer& renderer = i % 3 == 1 ? large : small;
        Frame frame = renderer.frame(i % 2);
        frame.cut = i == 5;
        frame.casters.topology = i % 3 == 1 ? 2 : 1;
        run(shadows, frame);
        EXPECT_EQ(renderer.visibility(0), i % 3 == 1 ? expected_large : expected) << "frame " << i;
    }
}

TEST(Embed, CastersMoveWithTheirTransforms) {
    const test::ValidationGuard guard;
    // The floor stays; everything else moves aside by a metre, on the device alone.
    test::LentRenderer renderer(hard_lit(load_scene("contact")), 160, 120);
    Result<Shadows> shadows = make("hard,resolution=2048");
    ASSERT_TRUE(shadows.ok()) << shadows.why();
    run(shadows.value(), renderer.frame());
    const std::vector<float> before = renderer.visibility(0);
    std::vector<mat4> poses(renderer.objects.size(), mat4(1));
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Box& box = renderer.scene.objects[i].bounds_ws;
        poses[i] = box.max.y - box.min.y > 1e-3F ? glm::translate(mat4(1), vec3(0, 50, 0)) : mat4(1);
    }
    write_buffer(device(), renderer.transforms, std::as_bytes(std::span(poses)));
    run(shadows.value(), renderer.frame());
    EXPECT_EQ(renderer.visibility(0), before) << "the same number of poses: what is kept may stay";
    ++renderer.poses;
    renderer.scene.bounds_ws.grow(vec3(0, 60, 0));
    run(shadows.value(), renderer.frame());
    const std::vector<float> after = renderer.visibility(0);
    std::size_t became_lit = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        const vec4 p = renderer.seen.position_ws[i];
        became_lit += p.w > 0 && before[i] == 0 && after[i] == 1 ? 1 : 0;
    }
    EXPECT_GT(became_lit, 100U);
}

TEST(Embed, KeptMapsFollowTheBoxesOfWhatMoved) {
    const test::ValidationGuard guard;
    const char* recipe = "hard,resolution=512,placement=cascades,cascades.scroll=1";
    test::LentRenderer renderer(hard_lit(load_scene("contact")), 160, 120);
    Result<Shadows> made = make(recipe);
    ASSERT_TRUE(made.ok()) << made.why();
    run(made.value(), renderer.frame());
    const std::vector<float> before = renderer.visibility(0);

    // All but the floor sinks by half, inside of the bounds.
    std::vector<mat4> poses(renderer.objects.size(), mat4(1));
    std::vector<Box> moved;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Box& box = renderer.scene.objects[i].bounds_ws;
        const vec3 step(0, -0.5F * (box.max.y - box.min.y), 0);
        if (step.y < -1e-3F) {
            poses[i] = glm::translate(mat4(1), step);
            moved.push_back(box);
            moved.push_back({box.min + step, box.max + step});
        }
    }
    write_buffer(device(), renderer.transforms, std::as_bytes(std::span(poses)));
    ++renderer.poses;
    const std::vector<float> after = alone(renderer, recipe, 0);
    ASSERT_NE(after, before);

    // What is told to have moved is drawn anew, and nothing else.
    Frame frame = renderer.frame();
    frame.casters.moved_ws = std::span<const Box>();
    run(made.value(), frame);
    EXPECT_EQ(renderer.visibility(0), before);
    ++renderer.poses;
    frame = renderer.frame();
    frame.casters.moved_ws = moved;
    run(made.value(), frame);
    EXPECT_EQ(renderer.visibility(0), after);
}

TEST(Embed, NormalsMayComeFromDepth) {
    const test::ValidationGuard guard;
    test::LentRenderer renderer(hard_lit(load_scene("stack")), 160, 120);
    Result<Shadows> shadows = make("hard,resolution=2048", {.normals = Normals::none});
    ASSERT_TRUE(shadows.ok()) << shadows.why();
    run(shadows.value(), renderer.frame());
    const Judged judged = judge(renderer, renderer.visibility(0), 0);
    // At the rim of a surface one pixel wide no neighbour lies on it.
    EXPECT_LT(judged.wrong, judged.counted / 500) << judged.counted;
    EXPECT_GT(judged.dark, 200U);
}

TEST(Embed, MistakesAreSentences) {
    EXPECT_NE(Shadows::create({}).why(), "");
    EXPECT_NE(make("pfc").why().find("pcf"), std::string::npos);
    EXPECT_NE(make("volumes").why().find("'volumes'"), std::string::npos) << make("volumes").why();
    EXPECT_NE(make("hard,casters=ids").why().find("casters=ids"), std::string::npos);

    test::LentRenderer renderer(hard_lit(load_scene("contact")), 96, 64);
    Result<Shadows> made = make("hard,placement=paraboloid", {}, {.width = 96, .height = 64, .lights = 1});
    ASSERT_TRUE(made.ok()) << made.why();
    Shadows& shadows = made.value();
    const auto why = [&](const Frame& frame) {
        std::string sentence;
        device().run([&](VkCommandBuffer commands) { sentence = shadows.record(commands, frame).why(); });
        return sentence;
    };
    Frame frame = renderer.frame();
    frame.slot = 7;
    EXPECT_NE(why(frame), "");
    frame = renderer.frame();
    frame.receivers.width = 97;
    EXPECT_NE(why(frame).find("97 x 64"), std::string::npos) << why(frame);
    frame = renderer.frame();
    frame.receivers.depth.image = VK_NULL_HANDLE;
    EXPECT_NE(why(frame).find("depth"), std::string::npos) << why(frame);
    frame = renderer.frame();
    frame.receivers.cs_from_ws = mat4(0);
    EXPECT_NE(why(frame).find("matrix"), std::string::npos) << why(frame);
    frame = renderer.frame();
    frame.casters.transforms.offset = VkDeviceSize{1} << 33U;
    EXPECT_NE(why(frame).find("the casters' transforms reach from byte 8589934592"), std::string::npos) << why(frame);
    frame = renderer.frame();
    frame.casters.topology = 2;
    frame.casters.indices.bytes = 12;
    EXPECT_NE(why(frame).find("caster object"), std::string::npos) << why(frame);

    // A light that the recipe does not serve is refused by itself, and lit.
    EXPECT_NE(shadows.refuses(renderer.scene.lights.front().shape).find("paraboloid"), std::string::npos);
    const std::vector<std::string> refused = run(shadows, renderer.frame());
    ASSERT_EQ(refused.size(), 1U);
    EXPECT_NE(refused.front().find("paraboloid"), std::string::npos) << refused.front();
    const std::vector<float> v = renderer.visibility(0);
    EXPECT_EQ(std::count(v.begin(), v.end(), 1.0F), static_cast<std::ptrdiff_t>(v.size()));
}

}  // namespace
}  // namespace gn::embed::embed_test
