// SPDX-License-Identifier: MIT
// A map of what did not change is drawn once, and is the map that a frame without history draws; whatever changes draws it
// anew.
#include "shadow/casters/kept_map.h"

#include "shadow/frame/history.h"
#include "shadow/scene/move.h"
#include "tests/rig.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gn::kept_map_test {
namespace {

struct Drawn {
    Image visibility;
    int map_passes = 0;  ///< of the shadow, besides the lookup
};

/// A scene on the device, seen again and again.
struct Sequence {
    explicit Sequence(Scene of) : scene(std::move(of)), gpu(upload_scene(test::device(), scene)) {}
    Scene scene;
    SceneGpu gpu;
    History history{test::device()};

    Drawn draw(const std::string& recipe, History* kept) {
        const test::ValidationGuard guard;
        const FrameResult frame =
            render_frame(test::device(), gpu, scene.camera(""), load_recipe(recipe),
                         {.width = 64, .height = 48, .repeat = 1, .only_light = 0, .picture = false, .history = kept});
        EXPECT_EQ(frame.refused.front(), "") << recipe;
        Drawn drawn{frame.visibility.front()};
        for (const PassTime& pass : frame.statistics.passes) {
            drawn.map_passes += pass.group == "shadow" && pass.name != "lookup" ? 1 : 0;
        }
        return drawn;
    }
    /// The next frame of the sequence; its V is that of a frame of its own.
    int next(const std::string& recipe) {
        const Drawn with = draw(recipe, &history);
        const Drawn without = draw(recipe, nullptr);
        EXPECT_EQ(std::memcmp(with.visibility.values.data(), without.visibility.values.data(),
                              without.visibility.values.size() * sizeof(float)),
                  0)
            << recipe;
        EXPECT_TRUE(with.map_passes == without.map_passes || with.map_passes == 0) << recipe;
        return with.map_passes;
    }
};

constexpr const char* lamp = "contact:light=spot";

/// Maps with blurs, mips, tables, several layers, and what is derived of them.
TEST(KeptMap, OfAStillLampIsDrawnOnceByEveryMap) {
    for (const char* recipe :
         {"hard", "hard,casters=ids", "hard,casters=dual", "hard,placement=single", "vsm,vsm.blur=box",
          "vsm,vsm.mipmaps=1", "sat-vsm", "evsm4", "esm", "msm", "convolution"}) {
        Sequence sequence{load_scene(lamp)};
        const std::string small = std::string(recipe) + ",resolution=128";
        EXPECT_GT(sequence.next(small), 0) << recipe;
        EXPECT_EQ(sequence.next(small), 0) << recipe;
        EXPECT_EQ(sequence.next(small), 0) << recipe;
    }
}

TEST(KeptMap, OfACubeIsDrawnOnce) {
    Sequence sequence{load_scene("contact:light=point")};
    EXPECT_EQ(sequence.next("hard,resolution=128"), 6);
    EXPECT_EQ(sequence.next("hard,resolution=128"), 0);
}

TEST(KeptMap, IsDrawnAnewWhereSomethingChanged) {
    using Change = std::function<void(Sequence&)>;
    const std::vector<std::pair<const char*, Change>> changes{
        {"a caster moved",
         [](Sequence& s) {
             move_object(s.scene, s.scene.objects.size() - 1, glm::translate(mat4(1), vec3(0.1F, 0, 0)));
             refresh_scene(test::device(), s.gpu);
         }},
        {"the lamp moved", [](Sequence& s) { s.scene.lights[0].shape.position_ws.x += 0.1F; }},
        {"an object stopped casting", [](Sequence& s) { s.scene.objects.back().casts = false; }},
        {"a material casts from one side only",
         [](Sequence& s) {
             bool& both = s.scene.materials[static_cast<std::size_t>(s.scene.objects.back().material)].double_sided;
             both = !both;
         }},
        {"the bulb is spared",
         [](Sequence& s) { s.scene.lights[0].spared = {static_cast<std::uint32_t>(s.scene.objects.size() - 1)}; }}};
    for (const auto& [what, change] : changes) {
        Sequence sequence{load_scene(lamp)};
        const std::string recipe = "pcf,placement=single,resolution=128";
        EXPECT_GT(sequence.next(recipe), 0);
        EXPECT_EQ(sequence.next(recipe), 0) << what;
        change(sequence);
        EXPECT_GT(sequence.next(recipe), 0) << what;
        EXPECT_EQ(sequence.next(recipe), 0) << what;
    }
}

TEST(KeptMap, FollowsAPlacementThatFollowsTheCamera) {
    Sequence sequence{load_scene(lamp)};
    const std::string recipe = "pcf,placement=fit,resolution=128";
    EXPECT_GT(sequence.next(recipe), 0);
    EXPECT_EQ(sequence.next(recipe), 0);
    // Nearer to what it looks at it sees less of it, and the map is fitted to that.
    Camera& camera = sequence.scene.cameras.front();
    camera.position_ws += 2.0F * camera.forward_ws;
    EXPECT_GT(sequence.next(recipe), 0);
    EXPECT_EQ(sequence.next(recipe), 0);
}

TEST(KeptMap, FollowsParametersAndNotTheLampsBrightness) {
    Sequence sequence{load_scene(lamp)};
    EXPECT_GT(sequence.next("vsm,vsm.radius=1,resolution=128"), 0);
    EXPECT_EQ(sequence.next("vsm,vsm.radius=1,resolution=128"), 0);
    EXPECT_GT(sequence.next("vsm,vsm.radius=2,resolution=128"), 0);
    EXPECT_GT(sequence.next("vsm,vsm.radius=2,resolution=256"), 0);
    sequence.scene.lights[0].shape.intensity *= 2;
    EXPECT_EQ(sequence.next("vsm,vsm.radius=2,resolution=256"), 0);
    sequence.history.clear();
    EXPECT_GT(sequence.next("vsm,vsm.radius=2,resolution=256"), 0);
}

TEST(KeptMap, OfAMapThatFollowsEarlierFramesIsDrawnInEveryFrame) {
    Sequence sequence{load_scene(lamp)};
    const std::string recipe = "lvsm,lvsm.splits=lloyd,resolution=128";
    const int passes = sequence.draw(recipe, &sequence.history).map_passes;
    EXPECT_GT(passes, 0);
    // A map that is found is found by the third frame: the second asks for its textures first.
    for (int frame = 1; frame < 3; ++frame) {
        EXPECT_EQ(sequence.draw(recipe, &sequence.history).map_passes, passes) << frame;
    }
}

}  // namespace
}  // namespace gn::kept_map_test
