// SPDX-License-Identifier: MIT
// Soft shadows at their limits: a light without extent is a hard shadow's, and where light, casters and receivers meet V stays a
// share of the light.
#include "tests/direct_scenes.h"
#include "tests/rig.h"

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

std::vector<float> values_of(const Scene& scene, const Recipe& recipe, std::size_t light) {
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame =
        render_frame(test::device(), gpu, scene.camera(""), recipe,
                     {.width = 64, .height = 48, .repeat = 0, .only_light = static_cast<int>(light), .picture = false});
    EXPECT_EQ(frame.refused.at(light), "");
    return frame.visibility.at(light).values;
}

/// With a least width of nothing a kernel is the texel that a hard shadow compares with.
TEST(SoftLimits, ALightWithoutExtentIsAHardShadows) {
    const test::ValidationGuard guard;
    for (const char* name : {"contact", "slab:light=point,hard=true"}) {
        const Scene& scene = test::built_in(name);
        const std::vector<float> hard = values_of(scene, load_recipe("hard,resolution=256,cube.edges=cross"), 0);
        EXPECT_GT(std::count(hard.begin(), hard.end(), 1.0F), 500) << name;
        for (const char* recipe : {"pcss,pcss.least=0", "chs,chs.least=0", "sssm,sssm.least=0", "backprojection",
                                   "soft,placement=auto,pcss.least=0", "soft-quality,placement=auto,pcss.least=0"}) {
            EXPECT_EQ(values_of(scene, load_recipe(std::string(recipe) + ",resolution=256"), 0), hard)
                << recipe << " in " << name;
        }
    }
}

/// What is filtered ahead is asked for one texel's footprint, and answers as it does to whoever filters nothing.
TEST(SoftLimits, OfPrefilteredMapsALightWithoutExtentReadsWhatTheyHoldUnfiltered) {
    const test::ValidationGuard guard;
    for (const char* recipe : {"vssm", "cssm"}) {
        const Scene& scene = test::built_in("contact");
        const std::string text = std::string(recipe) + ",resolution=256";
        const std::string whole = ",vssm.least=0,vssm.early_out=false,vssm.side=1";
        const std::vector<float> soft = values_of(scene, load_recipe(text + whole), 0);
        const std::vector<float> unfiltered =
            values_of(scene, load_recipe(text + ",lookup=filtered,filtered.footprint=radius,filtered.radius=0"), 0);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < soft.size(); ++i) {
            differ += std::abs(soft[i] - unfiltered[i]) > 1e-5F ? 1 : 0;
        }
        EXPECT_EQ(differ, 0U) << recipe;
    }
}

class SoftLimitsOf : public testing::TestWithParam<const char*> {};

/// A ball of light larger than its distance, whose middle a box goes through; a panel that stands on the ground, with a wall
/// through it; a spot whose disc the box cuts.
Scene meeting() {
    GnLight ball = by_hand::point({0, 0.8F, 0});
    ball.radius = 3;
    GnLight panel = by_hand::rectangle({-2, 0.5F, 0}, {0, 0.5F, 0});
    panel.half_size = vec2(0.5F);
    GnLight disc = by_hand::spot({0.3F, 1, 0.4F}, {1, 0, 1}, 1);
    disc.radius = 1.5F;
    return by_hand::SceneBuilder()
        .ground(5)
        .box({-0.5F, 0.4F, -0.5F}, {0.5F, 1.2F, 0.5F})
        .box({-2.2F, 0, -0.1F}, {-1.4F, 0.9F, 0.1F})
        .light(ball)
        .light(panel)
        .light(disc)
        .camera({1, 3, 4}, {-0.3F, 0.3F, 0})
        .scene();
}

TEST_P(SoftLimitsOf, WhereLightCastersAndReceiversMeetVIsAShareOfTheLight) {
    const test::ValidationGuard guard;
    const Scene scene = meeting();
    for (std::size_t light = 0; light < scene.lights.size(); ++light) {
        const std::vector<float> values = values_of(scene, load_recipe(GetParam()), light);
        EXPECT_EQ(std::count_if(values.begin(), values.end(), [](float v) { return !(v >= 0 && v <= 1); }), 0)
            << "of light " << light;
    }
}

INSTANTIATE_TEST_SUITE_P(Recipes, SoftLimitsOf,
                         testing::Values("pcss,resolution=128", "chs,resolution=128", "vssm,resolution=128",
                                         "cssm,resolution=64", "sssm,resolution=128", "backprojection,resolution=128",
                                         "backprojection-split,resolution=64",
                                         "accumulate,accumulate.lights=4,resolution=128", "soft,resolution=128",
                                         "soft-quality,resolution=128"),
                         [](const auto& info) {
                             std::string name = info.param;
                             name = name.substr(0, name.find(','));
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace gn
